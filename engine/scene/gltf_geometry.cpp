#include "engine/scene/gltf_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/base/error.h"
#include "engine/scene/gltf_instances.h"
#include "engine/scene/gltf_mesh_part.h"

namespace scene::gltf
{

namespace
{

constexpr uint64_t MAX_GEOMETRY_BYTES = uint64_t{1} << 31; // instances multiply what a small file can ask for

// What geometry takes, counted before it is allocated. Throws Error where that is too much.
class Budget
{
  public:
    Budget(const Document& document)
    {
        for (const tinygltf::Mesh& mesh : document.model.meshes) {
            double& bytes = meshBytes_.emplace_back(0); // no overflow, and exact far beyond the limit
            for (const tinygltf::Primitive& primitive : mesh.primitives) {
                const auto [vertices, triangles] = sizeOf(document, primitive);
                bytes += double(triangles) * sizeof(Triangle) + double(vertices) * VERTEX_BYTES;
            }
        }
    }
    void addCopies(size_t mesh, size_t count) { add(meshBytes_[mesh] * double(count)); }
    void addInstances(size_t count) { add(double(count) * INSTANCE_BYTES); }

  private:
    static constexpr size_t VERTEX_BYTES =
        sizeof(glm::dvec3) + 2 * sizeof(glm::vec3) + 2 * sizeof(glm::vec4) + 2 * sizeof(glm::vec2);
    static constexpr size_t INSTANCE_BYTES = sizeof(Instance) + 3 * sizeof(glm::dmat4); // and its tables

    void add(double bytes)
    {
        bytes_ += bytes;
        if (bytes_ > double(MAX_GEOMETRY_BYTES))
            throw Error("The meshes with all their instances need {:.0f} bytes, more than the limit of {}.", bytes_,
                        MAX_GEOMETRY_BYTES);
    }

    std::vector<double> meshBytes_;
    double bytes_ = 0;
};

std::vector<glm::dmat4> skinMatrices(const Document& document, const NodeTree& tree, MeshPartReader& reader,
                                     int skinIndex)
{
    const tinygltf::Skin& skin = document.model.skins[static_cast<size_t>(skinIndex)];
    std::vector<glm::dmat4> matrices;
    for (size_t i = 0; i < skin.joints.size(); ++i) {
        const glm::dmat4& world = tree.worldFromNode[static_cast<size_t>(skin.joints[i])];
        matrices.push_back(skin.inverseBindMatrices < 0 ? world
                                                        : world * reader.accessor(skin.inverseBindMatrices).mat4(i));
    }
    return matrices;
}

// Arrays of which some parts have nothing: filled up when the first part has something.
template <class T, class Get>
void append(std::vector<T>& array, size_t before, const MeshPart& part, bool has, const T& absent, Get&& get)
{
    if (!has && array.empty()) return;
    array.resize(before, absent);
    for (const Vertex& vertex : part.vertices) array.push_back(has ? T(get(vertex)) : absent);
}

void append(Geometry& scene, std::vector<glm::dvec3>& positions, const MeshPart& part, uint32_t material)
{
    const size_t before = positions.size();
    for (const Vertex& vertex : part.vertices) {
        positions.push_back(vertex.position);
        scene.normals.emplace_back(vertex.normal);
    }
    append(scene.tangents, before, part, part.hasTangents, glm::vec4(1, 0, 0, 1),
           [](const Vertex& v) { return v.tangent; });
    append(scene.uv0, before, part, part.hasUv[0], glm::vec2(0), [](const Vertex& v) { return v.uv[0]; });
    append(scene.uv1, before, part, part.hasUv[1], glm::vec2(0), [](const Vertex& v) { return v.uv[1]; });
    append(scene.colors, before, part, part.hasColors, glm::vec4(1), [](const Vertex& v) { return v.color; });
    const auto first = static_cast<uint32_t>(before);
    for (const auto& [a, b, c] : part.triangles)
        scene.triangles.push_back({{first + a, first + b, first + c}, material});
}

// Of the triangles whose corners are all finite; lower > upper: there are none.
Extent extentOf(const Geometry& geometry, const std::vector<glm::dvec3>& positions)
{
    constexpr double INF = std::numeric_limits<double>::infinity();
    Extent extent{glm::dvec3(INF), glm::dvec3(-INF)};
    for (const Triangle& triangle : geometry.triangles) {
        if (!std::ranges::all_of(triangle.vertices, [&](uint32_t v) { return isFinite(positions[v]); })) continue;
        for (const uint32_t v : triangle.vertices) extend(extent, {positions[v], positions[v]});
    }
    return extent;
}

// Positions relative to the origin, in float32.
void round(Geometry& geometry, const std::vector<glm::dvec3>& positions, const Extent& extent, const glm::dvec3& origin,
           double scale = 1)
{
    geometry.positions.reserve(positions.size());
    for (const glm::dvec3& position : positions) {
        const bool used = glm::all(glm::lessThanEqual(extent.lower, position)) &&
                          glm::all(glm::lessThanEqual(position, extent.upper));
        geometry.positions.push_back(used ? glm::vec3((position - origin) * scale)
                                          : glm::vec3(0)); // of dropped triangles only
    }
}

bool hasArea(const Geometry& geometry, const Triangle& triangle)
{
    const glm::dvec3 a = geometry.positions[triangle.vertices[0]];
    const glm::dvec3 b = geometry.positions[triangle.vertices[1]];
    const glm::dvec3 c = geometry.positions[triangle.vertices[2]];
    return glm::length(glm::cross(b - a, c - a)) >= SMALLEST_AREA;
}

// Moves the box's centre to the origin and rounds to float32; what has no area then is dropped, unless it moves. Of
// what moves, triangles may not be finite: at rest they are points.
void settle(Scene& scene, const std::vector<glm::dvec3>& positions, Motion* motion, Warnings& warnings)
{
    const Extent flat = extentOf(scene, positions);
    Extent all = flat;
    const std::vector<Box> boxes = boxesOf(scene.meshes);
    for (const Instance& instance : scene.instances)
        extend(all, extentOf(boxes[instance.mesh], instance.worldFromMesh));
    if (all.lower.x <= all.upper.x) { // there is a triangle
        const glm::dvec3 size = all.upper - all.lower;
        const double largest = std::max({size.x, size.y, size.z});
        if (!(largest <= LARGEST_SCENE))
            throw Error("The scene is {} m across, more than the limit of {} m.", largest, LARGEST_SCENE);
        scene.origin = 0.5 * all.lower + 0.5 * all.upper;
    }
    round(scene, positions, flat, scene.origin);
    for (Instance& instance : scene.instances) instance.worldFromMesh[3] -= glm::dvec4(scene.origin, 0);
    size_t kept = 0, part = 0;
    const size_t parts = motion ? motion->parts.size() : 0, before = scene.triangles.size();
    for (size_t i = 0, end = 0; i < before; ++i) { // end: of the part that moves
        for (; part < parts && motion->parts[part].firstTriangle == i; ++part) {
            end = i + motion->meshes[motion->parts[part].mesh].triangles.size();
            motion->parts[part].firstTriangle = static_cast<uint32_t>(kept);
        }
        const Triangle triangle = scene.triangles[i];
        if (i < end || hasArea(scene, triangle)) scene.triangles[kept++] = triangle;
    }
    scene.triangles.resize(kept);
    const size_t dropped = before - kept;
    if (dropped > 0) warnings.add("Dropped a triangle without area.", dropped);
}

std::string nameOf(int mesh, size_t primitive)
{
    return fmt::format("meshes[{}].primitives[{}]", mesh, primitive);
}

// Meshes that are stored once, as they are first met.
class StoredMeshes
{
  public:
    StoredMeshes(const Document& document, MeshPartReader& reader, Warnings& warnings)
        : document_(document), reader_(reader), warnings_(warnings)
    {
    }

    // Of this mesh of the file. Its space is moved and scaled by a power of two, so that coordinates are at most 1 or
    // so: no digits of where it lies in the file are lost, and few in the transform. Null: it has no triangle.
    struct Placed {
        uint32_t instance = 0; // Scene::instances
        glm::dmat4 nodeFromMesh = glm::dmat4(1);
    };
    std::optional<Placed> place(Scene& scene, int mesh, const glm::dmat4& worldFromNode, const glm::dmat4& nodeFromFile)
    {
        const auto [found, isNew] = meshes_.try_emplace(mesh);
        if (isNew) found->second = read(scene, mesh);
        const Stored& stored = found->second;
        if (stored.mesh == NONE) return {};
        const Placed placed{.instance = static_cast<uint32_t>(scene.instances.size()),
                            .nodeFromMesh =
                                glm::scale(glm::translate(nodeFromFile, stored.middle), glm::dvec3(stored.size))};
        scene.instances.push_back({.mesh = stored.mesh, .worldFromMesh = worldFromNode * placed.nodeFromMesh});
        return placed;
    }

  private:
    struct Stored {
        uint32_t mesh = NONE; // Scene::meshes; NONE: it has no triangle
        glm::dvec3 middle = {0, 0, 0};
        double size = 1;
    };

    Stored read(Scene& scene, int index)
    {
        const tinygltf::Mesh& mesh = document_.model.meshes[static_cast<size_t>(index)];
        Geometry geometry;
        std::vector<glm::dvec3> positions;
        for (size_t i = 0; i < mesh.primitives.size(); ++i) {
            if (!isDrawable(document_, mesh.primitives[i])) continue;
            const uint32_t material = materialOf(mesh.primitives[i], scene.materials.size());
            append(geometry, positions,
                   reader_.read(mesh.primitives[i], nameOf(index, i), {}, scene.materials[material]), material);
        }
        const Extent extent = extentOf(geometry, positions);
        const glm::dvec3 half = 0.5 * (extent.upper - extent.lower);
        const double radius = std::max({half.x, half.y, half.z});
        if (!(radius > 0)) return {};
        const Stored stored{.mesh = static_cast<uint32_t>(scene.meshes.size()),
                            .middle = 0.5 * (extent.lower + extent.upper),
                            .size = std::exp2(std::round(std::log2(radius)))};
        round(geometry, positions, extent, stored.middle, 1 / stored.size);
        const size_t dropped =
            std::erase_if(geometry.triangles, [&](const Triangle& triangle) { return !hasArea(geometry, triangle); });
        if (dropped > 0) warnings_.add("Dropped a triangle without area.", dropped);
        if (geometry.triangles.empty()) return {};
        scene.meshes.push_back(std::move(geometry));
        return stored;
    }

    const Document& document_;
    MeshPartReader& reader_;
    Warnings& warnings_;
    std::map<int, Stored> meshes_;
};

} // namespace

MotionPlan readGeometry(const Document& document, const NodeTree& tree, Scene& scene, Instancing instancing,
                        Warnings& warnings, const std::function<void(double)>& progress)
{
    const tinygltf::Model& model = document.model;
    MeshPartReader reader(document, warnings);
    MotionPlan plan = planMotion(document, tree, reader, warnings);
    const StoredOnce storedOnce(document, tree, reader, plan, scene.materials, instancing);
    const auto isMesh = [&](uint32_t node) { return model.nodes[node].mesh >= 0 && !tree.hidden[node]; };
    const auto moves = [&](uint32_t node) { return plan.motion && plan.movesMesh[node]; };
    Budget budget(document);
    for (size_t m = 0; m < model.meshes.size(); ++m) budget.addCopies(m, storedOnce.is(m) ? 1 : 0);
    for (const uint32_t n : tree.visible) {
        if (!isMesh(n)) continue;
        const size_t count = instanceCount(reader, model.nodes[n]);
        if (storedOnce.standsAt(n))
            budget.addInstances(count);
        else
            budget.addCopies(static_cast<size_t>(model.nodes[n].mesh), count);
    }

    std::vector<glm::dvec3> positions;
    StoredMeshes stored(document, reader, warnings);
    for (size_t n = 0; n < tree.visible.size(); ++n) {
        if (progress && n % 64 == 0) progress(static_cast<double>(n) / static_cast<double>(tree.visible.size()));
        const uint32_t nodeIndex = tree.visible[n];
        if (!isMesh(nodeIndex)) continue;
        const tinygltf::Node& node = model.nodes[nodeIndex];
        const tinygltf::Mesh& mesh = model.meshes[static_cast<size_t>(node.mesh)];
        Placement placement;
        placement.morphWeights = node.weights.empty() ? mesh.weights : node.weights;
        if (node.skin >= 0) placement.worldFromSkin = skinMatrices(document, tree, reader, node.skin);
        for (const glm::dmat4& instance : instancesOf(reader, node, warnings)) {
            placement.worldFromMesh = tree.worldFromNode[nodeIndex] * instance;
            const bool once = storedOnce.standsAt(nodeIndex), suits = once && suitsInstance(placement.worldFromMesh);
            if (once && !suits) budget.addCopies(static_cast<size_t>(node.mesh), 1);
            if (suits) {
                const auto placed = stored.place(scene, node.mesh, tree.worldFromNode[nodeIndex], instance);
                if (placed && moves(nodeIndex))
                    plan.motion->instances.push_back({placed->instance, plan.nodeOf[nodeIndex], placed->nodeFromMesh});
            }
            for (size_t i = 0; i < mesh.primitives.size(); ++i) {
                const tinygltf::Primitive& primitive = mesh.primitives[i];
                const std::string where = nameOf(node.mesh, i);
                if (!isDrawable(document, primitive)) {
                    warnings.add(fmt::format("Ignored {}: it has no positions, or only points or lines.", where));
                    continue;
                }
                if (suits) continue;
                const uint32_t index = materialOf(primitive, scene.materials.size());
                const Material& material = scene.materials[index];
                const Motion::Part part{.name = where,
                                        .nodeFromMesh = instance,
                                        .firstVertex = static_cast<uint32_t>(positions.size()),
                                        .firstTriangle = static_cast<uint32_t>(scene.triangles.size())};
                append(scene, positions,
                       moves(nodeIndex) ? addPart(plan, document, reader, i, nodeIndex, placement, part, material)
                                        : reader.read(primitive, where, placement, material),
                       index);
            }
        }
    }
    settle(scene, positions, plan.motion.get(), warnings);
    return plan;
}

} // namespace scene::gltf
