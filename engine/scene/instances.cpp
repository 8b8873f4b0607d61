#include "engine/scene/instances.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/base/error.h"
#include "engine/scene/attribute_tables.h"
#include "engine/scene/mesh.h"
#include "shaders/shared/bvh.h"
#include "shaders/shared/scene.h"

namespace scene
{

namespace
{

glm::dmat3 absolute(const glm::dmat3& m)
{
    return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])};
}

glm::uvec4 row(const glm::dvec3& v, double w)
{
    return std::bit_cast<glm::uvec4>(glm::vec4(float(v.x), float(v.y), float(v.z), float(w)));
}

glm::dvec3 rowOf(const glm::dmat3& m, int i)
{
    return {m[0][i], m[1][i], m[2][i]};
}

// Records and nodes of a tree behind those of others.
void append(MeshTables& tables, const Bvh& bvh)
{
    const auto nodes = uint32_t(tables.nodes.size() / shared::BVH_NODE_STRIDE);
    const auto records = uint32_t(tables.triangles.size() / shared::BVH_RECORD_STRIDE);
    const std::vector<glm::uvec4> moved = movedNodes(bvh.nodes, nodes, records);
    tables.nodes.insert(tables.nodes.end(), moved.begin(), moved.end());
    tables.triangles.insert(tables.triangles.end(), bvh.triangles.begin(), bvh.triangles.end());
    BvhStats& stats = tables.stats;
    stats.nodes += bvh.stats.nodes;
    stats.triangleRecords += bvh.stats.triangleRecords;
    stats.skippedTriangles += bvh.stats.skippedTriangles;
    stats.bytes += bvh.stats.bytes;
    stats.buildSeconds += bvh.stats.buildSeconds;
    stats.depth = std::max(stats.depth, bvh.stats.depth);
}

void requireFits(uint64_t rows, uint64_t maxTableBytes)
{
    if (rows * sizeof(glm::uvec4) > maxTableBytes)
        throw Error("The scene's meshes that are stored once need a table of {} bytes, more than the {} that this "
                    "device allows: simplify the scene, or choose another device with --device.",
                    rows * sizeof(glm::uvec4), maxTableBytes);
}

} // namespace

std::vector<bool> usedMaterials(const Scene& scene)
{
    std::vector<bool> used(scene.materials.size());
    for (const Triangle& triangle : scene.triangles) used[triangle.material] = true;
    for (const Geometry& mesh : scene.meshes)
        for (const Triangle& triangle : mesh.triangles) used[triangle.material] = true;
    return used;
}

bool suitsInstance(const glm::dmat4& worldFromMesh)
{
    constexpr double WORST = 4; // Skeel's condition number of a rotation times a scaling is at most 3
    const glm::dmat3 linear(worldFromMesh), inverse = glm::inverse(linear);
    if (!isFinite(glm::dvec3(worldFromMesh[3]))) return false;
    double condition = 0;
    const glm::dmat3 product = absolute(linear) * absolute(inverse);
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 entries = rowOf(product, i);
        if (!isFinite(entries)) return false;
        condition = std::max(condition, entries.x + entries.y + entries.z);
    }
    return condition <= WORST;
}

Box boxOf(const Geometry& mesh)
{
    Box box;
    for (const Triangle& triangle : mesh.triangles)
        for (const uint32_t v : triangle.vertices) box.extend({mesh.positions[v], mesh.positions[v]});
    return box;
}

void extend(Extent& extent, const Extent& by)
{
    extent.lower = glm::min(extent.lower, by.lower);
    extent.upper = glm::max(extent.upper, by.upper);
}

Extent extentOf(const Box& box, const glm::dmat4& worldFromMesh)
{
    const glm::dvec3 middle = 0.5 * (glm::dvec3(box.lower) + glm::dvec3(box.upper));
    const glm::dvec3 half = absolute(glm::dmat3(worldFromMesh)) * (glm::dvec3(box.upper) - middle);
    const glm::dvec3 center(worldFromMesh * glm::dvec4(middle, 1));
    return {center - half, center + half};
}

std::vector<Box> boxesOf(const std::vector<Geometry>& meshes)
{
    std::vector<Box> boxes;
    for (const Geometry& mesh : meshes) boxes.push_back(boxOf(mesh));
    return boxes;
}

double squaredRadiusOfInstances(const Scene& scene, std::span<const Box> boxes)
{
    double squared = 0;
    for (const Instance& instance : scene.instances) {
        if (!instance.visible) continue;
        const auto [lower, upper] = extentOf(boxes[instance.mesh], instance.worldFromMesh);
        const glm::dvec3 p = glm::max(glm::abs(lower), glm::abs(upper));
        squared = std::max(squared, glm::dot(p, p));
    }
    return squared;
}

MeshTables makeMeshTables(const Scene& scene, uint32_t attributeRows, uint64_t maxTableBytes)
{
    MeshTables tables;
    uint64_t most = 1, all = 0;
    for (const Geometry& mesh : scene.meshes) {
        most = std::max<uint64_t>(most, mesh.triangles.size());
        all += mesh.triangles.size();
    }
    tables.triangleBits = uint32_t(std::bit_width(most - 1));
    const uint64_t numbers = scene.triangles.size() + (uint64_t{scene.instances.size()} << tables.triangleBits);
    if (numbers >= shared::BVH_ALPHA_FLAG)
        throw Error("The scene has {} instances of meshes of up to {} triangles, too many to number: use fewer, or "
                    "simplify the meshes.",
                    scene.instances.size(), most);
    requireFits(all * attributeRows, maxTableBytes);
    for (const Geometry& mesh : scene.meshes) {
        std::vector<uint8_t> tests;
        for (const Triangle& triangle : mesh.triangles)
            tests.push_back(scene.materials[triangle.material].alpha != Alpha::Opaque);
        tables.meshes.push_back({.rootNode = uint32_t(tables.nodes.size() / shared::BVH_NODE_STRIDE),
                                 .attributeRow = uint32_t(tables.attributes.size()),
                                 .box = boxOf(mesh)});
        append(tables, buildBvh({.positions = mesh.positions, .triangles = mesh.triangles, .needsAlphaTest = tests},
                                maxTableBytes));
        const size_t first = tables.attributes.size();
        tables.attributes.resize(first + mesh.triangles.size() * attributeRows);
        for (size_t t = 0; t < mesh.triangles.size(); ++t)
            packAttributes(mesh, mesh.positions, shared::NO_INDEX, t,
                           std::span(tables.attributes).subspan(first + t * attributeRows, attributeRows));
    }
    requireFits(std::max(tables.nodes.size(), tables.triangles.size()), maxTableBytes);
    return tables;
}

PlaceTables placeInstances(const Scene& scene, const MeshTables& meshes, double lengthScale)
{
    PlaceTables tables{.flatTriangles = uint32_t(scene.triangles.size())};
    std::vector<glm::dmat4> transforms;
    std::vector<Box> boxes; // of those that are visible
    std::vector<uint32_t> visible;
    for (const Instance& instance : scene.instances) {
        const MeshTables::Mesh& mesh = meshes.meshes[instance.mesh];
        glm::dmat4 world = instance.worldFromMesh;
        for (int i = 0; i < 4; ++i) world[i] = glm::dvec4(glm::dvec3(world[i]) * lengthScale, world[i].w);
        transforms.push_back(world);
        const auto [lower, upper] = extentOf(mesh.box, world);
        if (instance.visible) {
            visible.push_back(uint32_t(transforms.size() - 1));
            boxes.push_back({glm::vec3(lower), glm::vec3(upper)});
        }
        const glm::dmat3 linear(world);
        const glm::dvec3 reach = glm::max(glm::abs(glm::dvec3(mesh.box.lower)), glm::abs(glm::dvec3(mesh.box.upper)));
        const glm::dvec3 size = glm::abs(glm::dvec3(world[3])) + absolute(linear) * reach;
        for (int i = 0; i < 3; ++i) tables.rows.push_back(row(rowOf(linear, i), world[3][i]));
        const uint32_t mirrors = glm::determinant(linear) < 0 ? shared::INSTANCE_MIRRORS : 0;
        glm::uvec4 last = row(glm::dvec3(0, size.x, size.y), size.z);
        last.x = mesh.attributeRow | mirrors;
        tables.rows.push_back(last);
    }
    BoxTree tree = buildBoxTree(boxes);
    tables.nodes = std::move(tree.nodes);
    for (const uint32_t leaf : tree.order) {
        const uint32_t i = visible[leaf];
        const glm::dmat3 inverse = glm::inverse(glm::dmat3(transforms[i]));
        for (int r = 0; r < 3; ++r) tables.records.push_back(row(rowOf(inverse, r), transforms[i][3][r]));
        tables.records.emplace_back(meshes.meshes[scene.instances[i].mesh].rootNode,
                                    tables.flatTriangles + (i << meshes.triangleBits), 0, 0);
    }
    return tables;
}

} // namespace scene
