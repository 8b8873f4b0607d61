#pragma once
// One primitive at one place: read, posed and brought into the world, before it joins the scene.

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/gltf_accessor.h"
#include "engine/scene/scene.h"

namespace scene::gltf
{

struct Vertex {
    glm::dvec3 position = {0, 0, 0};   // world
    glm::dvec3 normal = {0, 0, 0};     // unit; zero until one is found
    glm::dvec4 tangent = {0, 0, 0, 0}; // unit, handedness; zero until one is found
    std::array<glm::vec2, 2> uv = {};  // by set
    glm::vec4 color = {1, 1, 1, 1};
    bool mirrored = false; // by its transform: the winding turns
};

struct MeshPart {
    std::vector<Vertex> vertices;
    std::vector<std::array<uint32_t, 3>> triangles; // counter-clockwise from the front
    std::array<bool, 2> hasUv = {};
    bool hasTangents = false;
    bool hasColors = false;
};

// Where a mesh stands, and its pose.
struct Placement {
    glm::dmat4 worldFromMesh = glm::dmat4(1);
    std::vector<glm::dmat4> worldFromSkin; // by joint; empty: rigid
    const std::vector<double>* morphWeights = nullptr;
};

class MeshPartReader
{
  public:
    MeshPartReader(const Document& document, Warnings& warnings) : document_(document), warnings_(warnings) {}

    // Triangles with a vertex that is not finite are left out, with a warning. `where` is for messages:
    // meshes[1].primitives[0]. Throws Error: index out of range.
    MeshPart read(const tinygltf::Primitive& primitive, const std::string& where, const Placement& placement,
                  const Material& material);

    const Accessor& accessor(int index); // opened once

  private:
    struct Attribute; // base and weighted morph targets

    Attribute attribute(const tinygltf::Primitive& primitive, const std::string& name,
                        const std::vector<double>* weights);
    std::vector<std::array<uint32_t, 3>> readTriangles(const tinygltf::Primitive& primitive, size_t vertexCount,
                                                       const std::string& where);
    glm::dmat4 skinTransform(const tinygltf::Primitive& primitive, uint32_t element, const std::string& where,
                             const Placement& placement);
    void readVertices(const tinygltf::Primitive& primitive, const std::string& where, const Placement& placement,
                      const std::vector<uint32_t>& elements, MeshPart& part);

    const Document& document_;
    Warnings& warnings_;
    std::unordered_map<int, Accessor> accessors_;
    // For shared vertices: the part's vertex for an element, valid where the stamp is that of this part.
    std::vector<uint32_t> vertexOf_, stampOf_;
    uint32_t stamp_ = 0;
};

// Fills in what is missing: normals from the triangles (flat where vertices are not shared).
void completeNormals(MeshPart& part);

// Tangents from the texture coordinates `use` sees, for vertices without one; vertices on a mirror seam are doubled.
void completeTangents(MeshPart& part, const TextureUse& use);

} // namespace scene::gltf
