#pragma once
// Reads a primitive of a mesh: at once into the world where nothing moves it, or as it lies in the file.

#include <array>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/gltf_accessor.h"
#include "engine/scene/mesh.h"

namespace scene::gltf
{

class MeshPartReader
{
  public:
    MeshPartReader(const Document& document, Warnings& warnings) : document_(document), warnings_(warnings) {}

    // Triangles with a vertex that is not finite are left out, with a warning. `where` is for messages:
    // meshes[1].primitives[0]. Throws Error: index out of range.
    MeshPart read(const tinygltf::Primitive& primitive, const std::string& where, const Placement& placement,
                  const Material& material);

    // The same in its own space, with all its morph targets, for poses to come. `jointCount` is that of its skin; 0: it
    // has none. Mirror seams are split. Throws Error also where more is asked for than fits.
    Mesh readMesh(const tinygltf::Primitive& primitive, const std::string& where, size_t jointCount,
                  const Material& material);

    // Such a mesh at rest, with the warnings of read(). Its triangles stay all, also those that are not finite.
    MeshPart place(const Mesh& mesh, const std::string& where, const Placement& placement, const Material& material);

    const Accessor& accessor(int index); // opened once

  private:
    struct Source; // the accessors of a primitive

    Source open(const tinygltf::Primitive& primitive, const std::string& where, size_t jointCount,
                const Material& material);
    std::vector<std::array<uint32_t, 3>> readTriangles(const tinygltf::Primitive& primitive, size_t vertexCount,
                                                       const std::string& where);
    std::vector<uint32_t> usedElements(std::vector<std::array<uint32_t, 3>>& triangles, size_t elementCount, bool flat);
    MeshVertices gather(const Source& source, std::span<const uint32_t> elements, std::span<const double> weights);
    void warn(const MeshPart& part, const std::string& where, const Material& material);
    void gatherInfluences(const Source& source, std::span<const uint32_t> elements, MeshVertices& vertices);

    const Document& document_;
    Warnings& warnings_;
    std::unordered_map<int, Accessor> accessors_;
    // For shared vertices: the part's vertex for an element, valid where the stamp is that of this part.
    std::vector<uint32_t> vertexOf_, stampOf_;
    uint32_t stamp_ = 0;
    uint64_t displacements_ = 0; // that readMesh() has read so far, by vertex and target
};

} // namespace scene::gltf
