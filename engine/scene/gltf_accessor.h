#pragma once
// Reads the elements of an accessor whatever its storage: stride, sparse, normalized integers, no buffer at all
// (zeros).

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/gltf_document.h"

namespace scene::gltf
{

// Refers to the document's bytes. checkJson has shown that every element lies inside them.
class Accessor
{
  public:
    Accessor(const Document& document, int index); // throws Error for sparse indices out of range or order

    size_t count() const { return count_; }
    uint32_t components() const { return components_; }

    double number(size_t element, uint32_t component) const; // normalized integers in [0,1] or [-1,1]
    uint32_t integer(size_t element, uint32_t component) const;
    glm::dvec3 vec3(size_t element) const { return {number(element, 0), number(element, 1), number(element, 2)}; }
    glm::dmat4 mat4(size_t element) const;

  private:
    const std::byte* at(size_t element, uint32_t component) const; // null: zero

    size_t count_;
    uint32_t components_;
    int componentType_;
    bool normalized_;
    uint32_t componentSize_;
    size_t stride_ = 0;
    std::span<const std::byte> base_;
    std::vector<uint32_t> sparseIndices_;
    std::span<const std::byte> sparseValues_;
};

} // namespace scene::gltf
