#pragma once
// A mesh in its own space, and what it becomes where it stands: morphed, skinned, in the world (glTF 2.0, 3.7).

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/scene.h"

namespace scene
{

constexpr double LARGEST_SCENE = 1e9;   // metres; products of lengths as traversal forms them stay inside float32
constexpr double SMALLEST_AREA = 1e-19; // twice the area, m^2; below, the square of the normal underflows in float32

enum Attribute : uint32_t { POSITION, NORMAL, TANGENT, TEXCOORD_0, TEXCOORD_1, COLOR_0, ATTRIBUTES };
constexpr std::array<uint32_t, ATTRIBUTES> ATTRIBUTE_WIDTH = {3, 3, 4, 2, 2, 4};

// What a morph target adds to an attribute at weight 1: to the vertices that it moves alone, in their order.
struct Displacements {
    std::vector<uint32_t> vertices;
    std::vector<double> values; // ATTRIBUTE_WIDTH numbers for each
};
using MorphTarget = std::array<Displacements, ATTRIBUTES>;

// Of a joint of the skin on a vertex.
struct Influence {
    uint32_t joint = 0;
    double weight = 0;
};

// Vertices as the file gives them, in float64, so that every pose rounds once.
struct MeshVertices {
    size_t count = 0;
    std::array<std::vector<double>, ATTRIBUTES> values; // ATTRIBUTE_WIDTH numbers a vertex; empty: there is none
    std::vector<MorphTarget> targets;
    std::vector<uint32_t> influenceEnds; // by vertex, into influences; empty: not skinned
    std::vector<Influence> influences;   // of a vertex without any: it stands where its mesh stands
};

struct Mesh {
    MeshVertices vertices;
    std::vector<std::array<uint32_t, 3>> triangles; // counter-clockwise from the front
    bool hasTangents = false;                       // where there are no values, they come from the texture
};

// Where a mesh stands, and its pose.
struct Placement {
    glm::dmat4 worldFromMesh = glm::dmat4(1);
    std::vector<glm::dmat4> worldFromSkin; // by joint; empty: rigid. With a skin, worldFromMesh moves nothing (3.7.3.3)
    std::span<const double> morphWeights;  // by target; those beyond the last count nothing
};

struct Vertex {
    glm::dvec3 position = {0, 0, 0};   // world
    glm::dvec3 normal = {0, 0, 0};     // unit; zero until one is found
    glm::dvec4 tangent = {0, 0, 0, 0}; // unit, handedness; zero until one is found
    std::array<glm::vec2, 2> uv = {};  // by set
    glm::vec4 color = {1, 1, 1, 1};
    bool mirrored = false; // by its transform: the winding turns
};

// What had to be replaced by something sane.
struct Replaced {
    size_t uvs = 0;     // not finite or beyond 1e6, by 0
    size_t colors = 0;  // outside 0 to 1
    size_t normals = 0; // without a direction, by that of the triangles
};

struct MeshPart {
    std::vector<Vertex> vertices;
    std::vector<std::array<uint32_t, 3>> triangles; // counter-clockwise from the front
    std::array<bool, 2> hasUv = {};
    bool hasTangents = false;
    bool hasColors = false;
    Replaced replaced;
};

bool isFinite(const glm::dvec3& v);

// Whether all corners of one of its triangles are. Those that are not give their vertices no normal and no tangent.
bool isFinite(const MeshPart& part, const std::array<uint32_t, 3>& triangle);

// The vertices in the world, one of `posed` for each; normals and tangents as far as they are given.
void poseVertices(const MeshVertices& vertices, const Placement& placement, std::span<Vertex> posed,
                  Replaced& replaced);

// Turns the triangles whose first vertex is mirrored, so that their front stays the front.
void turnMirrored(MeshPart& part);

// Fills in what is missing: normals from the triangles (flat where vertices are not shared; glTF 2.0, 3.7.2.1).
void completeNormals(MeshPart& part);

// Tangents from the texture coordinates `use` sees, for vertices without one. With `split`, vertices on a mirror seam
// are doubled: the copies come last. Returns the originals of the copies.
std::vector<uint32_t> completeTangents(MeshPart& part, const TextureUse& use, bool split);

// Doubles the vertices on mirror seams once for all poses: in no pose completeTangents() has any left to split.
void splitSeams(Mesh& mesh, const TextureUse& use);

// The whole mesh in the world: the same vertices and triangles, in the same order, in every pose.
MeshPart poseMesh(const Mesh& mesh, const Placement& placement, const TextureUse& normalTexture);

} // namespace scene
