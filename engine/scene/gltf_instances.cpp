#include "engine/scene/gltf_instances.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "engine/scene/gltf_values.h"

namespace scene::gltf
{

namespace
{

constexpr uint64_t MANY_COPIES = uint64_t{1} << 20; // triangles, of all meshes together
constexpr uint64_t FEW_TRIANGLES = 64;              // of a mesh: an instance takes about as much memory

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

size_t countOf(const std::array<const Accessor*, 3>& instancing)
{
    const auto any = std::ranges::find_if(instancing, [](const Accessor* accessor) { return accessor != nullptr; });
    return any == instancing.end() ? 1 : (*any)->count();
}

// In some pose, if not at rest.
bool emits(const Document& document, const tinygltf::Mesh& mesh, const std::vector<Material>& materials)
{
    return std::ranges::any_of(mesh.primitives, [&](const tinygltf::Primitive& primitive) {
        if (!isDrawable(document, primitive)) return false;
        const uint32_t material = materialOf(primitive, materials.size());
        const auto moves = [&](Property property) { return document.animations.moved.contains({property, material}); };
        return materials[material].emission != glm::vec3(0) || moves(Property::EmissiveFactor) ||
               moves(Property::EmissiveStrength);
    });
}

// Whether the transform is a rotation, a mirroring and a scaling by one factor.
bool isSimilarity(const glm::dmat4& m)
{
    const glm::dmat3 linear(m), product = glm::transpose(linear) * linear;
    const double square = product[0][0];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (!(std::abs(product[i][j] - (i == j ? square : 0)) <= 1e-6 * square)) return false;
    return square > 0;
}

// In all poses: then what is stored once suits all of them.
bool movesRigidly(const Document& document, const NodeTree& tree, uint32_t node)
{
    for (; node != NONE; node = tree.parents[node])
        if (!isSimilarity(tree.worldFromNode[node]) || document.animations.moved.contains({Property::Scale, node}))
            return false;
    return true;
}

} // namespace

std::vector<glm::dmat4> instancesOf(MeshPartReader& reader, const tinygltf::Node& node, Warnings& warnings)
{
    const auto accessors = instancingOf(reader, node);
    const auto [translations, rotations, scales] = accessors;
    std::vector<glm::dmat4> instances(countOf(accessors), glm::dmat4(1));
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

uint32_t materialOf(const tinygltf::Primitive& primitive, size_t materials)
{
    return static_cast<uint32_t>(primitive.material < 0 ? materials - 1 : static_cast<size_t>(primitive.material));
}

PrimitiveSize sizeOf(const Document& document, const tinygltf::Primitive& primitive)
{
    if (!isDrawable(document, primitive)) return {};
    const auto count = [&](int accessor) { return document.model.accessors[static_cast<size_t>(accessor)].count; };
    const uint64_t elements = count(primitive.attributes.at("POSITION"));
    const uint64_t corners = primitive.indices < 0 ? elements : count(primitive.indices);
    const uint64_t triangles = primitive.mode == TINYGLTF_MODE_TRIANGLES ? corners / 3 : corners;
    const bool flat = !primitive.attributes.contains("NORMAL");
    return {.vertices = flat ? 3 * triangles : std::min(elements, 3 * triangles), .triangles = triangles};
}

size_t instanceCount(MeshPartReader& reader, const tinygltf::Node& node)
{
    return countOf(instancingOf(reader, node));
}

StoredOnce::StoredOnce(const Document& document, const NodeTree& tree, MeshPartReader& reader, const MotionPlan& plan,
                       const std::vector<Material>& materials, Instancing instancing)
    : chosen_(document.model.meshes.size(), false), mayStand_(document.model.nodes.size(), false)
{
    for (const tinygltf::Node& node : document.model.nodes) meshOf_.push_back(node.mesh);
    if (instancing == Instancing::Off) return;
    const std::vector<tinygltf::Mesh>& meshes = document.model.meshes;
    const bool on = instancing == Instancing::On;
    std::vector<uint64_t> places(meshes.size(), 0), moving(meshes.size(), 0);
    for (const uint32_t n : tree.visible) {
        const tinygltf::Node& node = document.model.nodes[n];
        if (node.mesh < 0 || tree.hidden[n] || node.skin >= 0) continue;
        const bool moves = plan.motion && plan.movesMesh[n];
        if (moves && !movesRigidly(document, tree, n)) continue;
        mayStand_[n] = true;
        places[static_cast<size_t>(node.mesh)] += instanceCount(reader, node);
        moving[static_cast<size_t>(node.mesh)] += moves;
    }
    double copies = 0; // no overflow
    for (size_t m = 0; m < meshes.size(); ++m) {
        uint64_t triangles = 0;
        bool morphs = false;
        for (const tinygltf::Primitive& primitive : meshes[m].primitives) {
            triangles += sizeOf(document, primitive).triangles;
            morphs |= !primitive.targets.empty();
        }
        const bool worth = on ? triangles > 0 : triangles >= FEW_TRIANGLES;
        chosen_[m] =
            (places[m] > 1 || (on && moving[m] > 0)) && worth && !morphs && !emits(document, meshes[m], materials);
        if (chosen_[m]) copies += static_cast<double>(places[m] - 1) * static_cast<double>(triangles);
    }
    if (!on && copies < static_cast<double>(MANY_COPIES)) chosen_.assign(meshes.size(), false);
}

} // namespace scene::gltf
