#include "engine/scene/gltf_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "engine/base/error.h"
#include "engine/scene/gltf_mesh_part.h"
#include "engine/scene/gltf_values.h"

namespace scene::gltf
{

namespace
{

constexpr uint64_t MAX_GEOMETRY_BYTES = uint64_t{1} << 31; // instances multiply what a small file can ask for

// Of EXT_mesh_gpu_instancing: translations, rotations and scales, those that there are.
std::array<const Accessor*, 3> instancingOf(MeshPartReader& reader, const tinygltf::Node& node)
{
    std::array<const Accessor*, 3> accessors = {};
    const tinygltf::Value* instancing = findExtension(node.extensions, "EXT_mesh_gpu_instancing");
    for (size_t i = 0; instancing && i < accessors.size(); ++i) {
        const std::string name = std::array{"TRANSLATION", "ROTATION", "SCALE"}[i];
        const tinygltf::Value& attributes = instancing->Get("attributes");
        if (attributes.Has(name)) accessors[i] = &reader.accessor(attributes.Get(name).GetNumberAsInt());
    }
    return accessors;
}

size_t instanceCount(const std::array<const Accessor*, 3>& instancing)
{
    const auto any = std::ranges::find_if(instancing, [](const Accessor* accessor) { return accessor != nullptr; });
    return any == instancing.end() ? 1 : (*any)->count();
}

// EXT_mesh_gpu_instancing: translation, rotation and scale of each instance inside the node; else the node itself.
std::vector<glm::dmat4> instancesOf(MeshPartReader& reader, const tinygltf::Node& node, Warnings& warnings)
{
    const auto accessors = instancingOf(reader, node);
    const auto [translations, rotations, scales] = accessors;
    std::vector<glm::dmat4> instances(instanceCount(accessors), glm::dmat4(1));
    for (size_t i = 0; i < instances.size(); ++i) {
        if (translations) instances[i] = glm::translate(instances[i], translations->vec3(i));
        if (rotations) {
            const glm::dquat rotation(rotations->number(i, 3), rotations->number(i, 0), rotations->number(i, 1),
                                      rotations->number(i, 2));
            const double length = std::sqrt(glm::dot(rotation, rotation));
            if (length > 0)
                instances[i] *= glm::mat4_cast(rotation / length);
            else
                warnings.add("Ignored the rotation of an instance, which is zero.");
        }
        if (scales) instances[i] = glm::scale(instances[i], scales->vec3(i));
    }
    return instances;
}

bool isDrawable(const Document& document, const tinygltf::Primitive& primitive)
{
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end() || primitive.mode < TINYGLTF_MODE_TRIANGLES) return false;
    const tinygltf::Accessor& accessor = document.model.accessors[static_cast<size_t>(position->second)];
    return accessor.bufferView >= 0 || accessor.sparse.isSparse; // else all vertices coincide
}

// An upper bound, before anything is allocated.
void checkSize(const Document& document, const NodeTree& tree, MeshPartReader& reader)
{
    constexpr uint64_t VERTEX_BYTES =
        sizeof(glm::dvec3) + 2 * sizeof(glm::vec3) + 2 * sizeof(glm::vec4) + 2 * sizeof(glm::vec2);
    const auto bytesOf = [&](const tinygltf::Mesh& mesh) {
        uint64_t bytes = 0;
        for (const tinygltf::Primitive& primitive : mesh.primitives) {
            if (!isDrawable(document, primitive)) continue;
            const uint64_t elements =
                document.model.accessors[static_cast<size_t>(primitive.attributes.at("POSITION"))].count;
            const uint64_t corners = primitive.indices < 0
                                         ? elements
                                         : document.model.accessors[static_cast<size_t>(primitive.indices)].count;
            const uint64_t triangles = primitive.mode == TINYGLTF_MODE_TRIANGLES ? corners / 3 : corners;
            const bool flat = !primitive.attributes.contains("NORMAL");
            bytes += triangles * sizeof(Triangle) +
                     (flat ? 3 * triangles : std::min(elements, 3 * triangles)) * VERTEX_BYTES;
        }
        return bytes;
    };
    std::vector<uint64_t> meshBytes;
    for (const tinygltf::Mesh& mesh : document.model.meshes) meshBytes.push_back(bytesOf(mesh));
    double bytes = 0; // no overflow, and exact far beyond the limit
    for (const uint32_t i : tree.visible) {
        const tinygltf::Node& node = document.model.nodes[i];
        if (node.mesh >= 0 && !tree.hidden[i])
            bytes += static_cast<double>(meshBytes[static_cast<size_t>(node.mesh)]) *
                     static_cast<double>(instanceCount(instancingOf(reader, node)));
    }
    if (bytes > static_cast<double>(MAX_GEOMETRY_BYTES))
        throw Error("The meshes with all their instances need {:.0f} bytes, more than the limit of {}.", bytes,
                    MAX_GEOMETRY_BYTES);
}

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

void append(Scene& scene, std::vector<glm::dvec3>& positions, const MeshPart& part, uint32_t material)
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

// Moves the box's centre to the origin and rounds to float32; what has no area then is dropped, unless it moves. Of
// what moves, triangles may not be finite: at rest they are points.
void settle(Scene& scene, const std::vector<glm::dvec3>& positions, Motion* motion, Warnings& warnings)
{
    constexpr double INF = std::numeric_limits<double>::infinity();
    glm::dvec3 low(INF), high(-INF);
    for (const Triangle& triangle : scene.triangles) {
        if (!std::ranges::all_of(triangle.vertices, [&](uint32_t v) { return isFinite(positions[v]); })) continue;
        for (const uint32_t v : triangle.vertices) {
            low = glm::min(low, positions[v]);
            high = glm::max(high, positions[v]);
        }
    }
    if (low.x <= high.x) { // there is one
        const glm::dvec3 size = high - low;
        const double largest = std::max({size.x, size.y, size.z});
        if (!(largest <= LARGEST_SCENE))
            throw Error("The scene is {} m across, more than the limit of {} m.", largest, LARGEST_SCENE);
        scene.origin = 0.5 * low + 0.5 * high;
    }
    scene.positions.reserve(positions.size());
    for (const glm::dvec3& position : positions) {
        const bool used = glm::all(glm::lessThanEqual(low, position)) && glm::all(glm::lessThanEqual(position, high));
        scene.positions.push_back(used ? glm::vec3(position - scene.origin)
                                       : glm::vec3(0)); // of dropped triangles only
    }
    size_t kept = 0, part = 0;
    const size_t parts = motion ? motion->parts.size() : 0, before = scene.triangles.size();
    for (size_t i = 0, end = 0; i < before; ++i) { // end: of the part that moves
        for (; part < parts && motion->parts[part].firstTriangle == i; ++part) {
            end = i + motion->meshes[motion->parts[part].mesh].triangles.size();
            motion->parts[part].firstTriangle = static_cast<uint32_t>(kept);
        }
        const Triangle triangle = scene.triangles[i];
        const glm::dvec3 a = scene.positions[triangle.vertices[0]];
        const glm::dvec3 b = scene.positions[triangle.vertices[1]];
        const glm::dvec3 c = scene.positions[triangle.vertices[2]];
        if (i < end || glm::length(glm::cross(b - a, c - a)) >= SMALLEST_AREA) scene.triangles[kept++] = triangle;
    }
    scene.triangles.resize(kept);
    const size_t dropped = before - kept;
    if (dropped > 0) warnings.add("Dropped a triangle without area.", dropped);
}

} // namespace

MotionPlan readGeometry(const Document& document, const NodeTree& tree, Scene& scene, Warnings& warnings,
                        const std::function<void(double)>& progress)
{
    const tinygltf::Model& model = document.model;
    MeshPartReader reader(document, warnings);
    checkSize(document, tree, reader);
    MotionPlan plan = planMotion(document, tree, reader, warnings);

    std::vector<glm::dvec3> positions;
    for (size_t n = 0; n < tree.visible.size(); ++n) {
        if (progress && n % 64 == 0) progress(static_cast<double>(n) / static_cast<double>(tree.visible.size()));
        const uint32_t nodeIndex = tree.visible[n];
        const tinygltf::Node& node = model.nodes[nodeIndex];
        if (node.mesh < 0 || tree.hidden[nodeIndex]) continue;
        const tinygltf::Mesh& mesh = model.meshes[static_cast<size_t>(node.mesh)];
        Placement placement;
        placement.morphWeights = node.weights.empty() ? mesh.weights : node.weights;
        if (node.skin >= 0) placement.worldFromSkin = skinMatrices(document, tree, reader, node.skin);
        for (const glm::dmat4& instance : instancesOf(reader, node, warnings)) {
            placement.worldFromMesh = tree.worldFromNode[nodeIndex] * instance;
            for (size_t i = 0; i < mesh.primitives.size(); ++i) {
                const tinygltf::Primitive& primitive = mesh.primitives[i];
                const std::string where = fmt::format("meshes[{}].primitives[{}]", node.mesh, i);
                if (!isDrawable(document, primitive)) {
                    warnings.add(fmt::format("Ignored {}: it has no positions, or only points or lines.", where));
                    continue;
                }
                const size_t index =
                    primitive.material < 0 ? scene.materials.size() - 1 : static_cast<size_t>(primitive.material);
                const Material& material = scene.materials[index];
                const Motion::Part part{.name = where,
                                        .nodeFromMesh = instance,
                                        .firstVertex = static_cast<uint32_t>(positions.size()),
                                        .firstTriangle = static_cast<uint32_t>(scene.triangles.size())};
                append(scene, positions,
                       plan.motion && plan.movesMesh[nodeIndex]
                           ? addPart(plan, document, reader, i, nodeIndex, placement, part, material)
                           : reader.read(primitive, where, placement, material),
                       static_cast<uint32_t>(index));
            }
        }
    }
    settle(scene, positions, plan.motion.get(), warnings);
    return plan;
}

} // namespace scene::gltf
