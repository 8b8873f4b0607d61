#pragma once
// Meshes that are stored once and stand in many places: a tree each, and one over the places (two levels). What a
// triangle is called in its place: shaders/shared/scene.h.

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/bvh.h"
#include "engine/scene/scene.h"

namespace scene
{

// Which meshes of a file are stored once: those in several places where copies would be many, or wherever they are, or
// none.
enum class Instancing { Auto, On, Off };

// Whether rays may be taken through the transform: it is not singular, and rounding does no more there than elsewhere,
// as in products of a rotation and a scaling. Others are applied to the vertices.
bool suitsInstance(const glm::dmat4& worldFromMesh);

// Of a mesh in its own space, which has triangles, and where it stands: from the corners of its box.
Box boxOf(const Geometry& mesh);
struct Extent {
    glm::dvec3 lower, upper;
};
void extend(Extent& extent, const Extent& by);
Extent extentOf(const Box& box, const glm::dmat4& worldFromMesh);

std::vector<Box> boxesOf(const std::vector<Geometry>& meshes);

// Of a sphere about the origin that holds all boxes of instances; `boxes` are those of the meshes.
double squaredRadiusOfInstances(const Scene& scene, std::span<const Box> boxes);

// As tables. Rows of what all poses share: trees, records and attributes of the meshes, one after the other.
struct MeshTables {
    std::vector<glm::uvec4> nodes, triangles, attributes;
    struct Mesh {
        uint32_t rootNode = 0;     // nodes
        uint32_t attributeRow = 0; // rows
        Box box;
    };
    std::vector<Mesh> meshes;
    uint32_t triangleBits = 0; // of a triangle's index within its mesh
    BvhStats stats;            // of the trees together
};

// Of a pose: the tree over the places, whose records are places, and the rows of table SceneData for them.
struct PlaceTables {
    std::vector<glm::uvec4> nodes, records;
    std::vector<glm::uvec4> rows;
    uint32_t flatTriangles = 0; // those before the first instance's
};

// `attributeRows`: of a triangle. Throws Error where the tables exceed maxTableBytes each, or the
// triangles of all instances have no numbers.
MeshTables makeMeshTables(const Scene& scene, uint32_t attributeRows, uint64_t maxTableBytes);

// Of the world scaled by lengthScale; meshes are as they are.
PlaceTables placeInstances(const Scene& scene, const MeshTables& meshes, double lengthScale);

} // namespace scene
