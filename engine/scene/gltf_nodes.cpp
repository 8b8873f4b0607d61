#include "engine/scene/gltf_nodes.h"

#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "engine/base/error.h"
#include "engine/scene/gltf_json.h"
#include "engine/scene/gltf_values.h"

namespace scene::gltf
{

namespace
{

glm::dmat4 localTransform(const tinygltf::Node& node, size_t index, Warnings& warnings)
{
    glm::dmat4 matrix(1);
    if (!node.matrix.empty()) {
        for (size_t i = 0; i < 16; ++i) matrix[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = node.matrix[i];
        if (matrix[0][3] != 0 || matrix[1][3] != 0 || matrix[2][3] != 0 || matrix[3][3] != 1)
            throw Error("nodes[{}].matrix is no affine transform: its last row must be 0 0 0 1.", index);
        return matrix;
    }
    if (!node.translation.empty())
        matrix = glm::translate(matrix, {node.translation[0], node.translation[1], node.translation[2]});
    if (!node.rotation.empty()) {
        const auto& r = node.rotation; // x, y, z, w
        const glm::dquat rotation(r[3], r[0], r[1], r[2]);
        const double length = std::sqrt(glm::dot(rotation, rotation));
        if (!(length > 0)) throw Error("nodes[{}].rotation is zero, which is no rotation.", index);
        if (std::abs(length - 1) > 0.01) warnings.add("Normalized the rotation of a node.");
        matrix *= glm::mat4_cast(rotation / length);
    }
    if (!node.scale.empty()) matrix = glm::scale(matrix, {node.scale[0], node.scale[1], node.scale[2]});
    return matrix;
}

bool isPlaced(const glm::dvec3& position)
{
    constexpr double FARTHEST = 1e12; // metres; its square is far inside float32
    return std::max({std::abs(position.x), std::abs(position.y), std::abs(position.z)}) < FARTHEST;
}

std::vector<int> sceneRoots(const Document& document, const std::vector<uint32_t>& roots, Warnings& warnings)
{
    const tinygltf::Model& model = document.model;
    if (!model.scenes.empty()) {
        if (model.scenes.size() > 1 && model.defaultScene < 0)
            warnings.add("The file names no default scene: took the first.");
        return model.scenes[static_cast<size_t>(std::max(model.defaultScene, 0))].nodes;
    }
    if (!model.nodes.empty()) warnings.add("The file has no scene: took all its nodes.");
    return {roots.begin(), roots.end()};
}

} // namespace

NodeTree resolveNodes(const Document& document, Warnings& warnings)
{
    // Iterative throughout: chains may be as long as the file.
    const auto& nodes = document.model.nodes;
    std::vector<bool> isChild(nodes.size(), false);
    for (const tinygltf::Node& node : nodes) {
        for (const int child : node.children) isChild[static_cast<size_t>(child)] = true;
    }
    NodeTree tree;
    tree.worldFromNode.resize(nodes.size());
    std::vector<uint32_t> roots, pending;
    for (uint32_t i = 0; i < nodes.size(); ++i) {
        if (isChild[i]) continue;
        roots.push_back(i);
        tree.worldFromNode[i] = localTransform(nodes[i], i, warnings);
        pending.push_back(i);
    }
    while (!pending.empty()) {
        const uint32_t parent = pending.back();
        pending.pop_back();
        for (const int child : nodes[parent].children) {
            const auto i = static_cast<uint32_t>(child);
            tree.worldFromNode[i] = tree.worldFromNode[parent] * localTransform(nodes[i], i, warnings);
            pending.push_back(i);
        }
    }

    std::vector<bool> seen(nodes.size(), false);
    const std::vector<int> shownRoots = sceneRoots(document, roots, warnings);
    pending.assign(shownRoots.rbegin(), shownRoots.rend());
    while (!pending.empty()) {
        const uint32_t i = pending.back();
        pending.pop_back();
        if (seen[i]) continue; // a scene may list a node and its ancestor
        seen[i] = true;
        tree.visible.push_back(i);
        pending.insert(pending.end(), nodes[i].children.rbegin(), nodes[i].children.rend());
    }
    return tree;
}

std::vector<Camera> readCameras(const Document& document, const NodeTree& tree, const glm::dvec3& origin,
                                Warnings& warnings)
{
    std::vector<Camera> cameras;
    for (const uint32_t i : tree.visible) {
        const tinygltf::Node& node = document.model.nodes[i];
        if (node.camera < 0) continue;
        const tinygltf::Camera& source = document.model.cameras[static_cast<size_t>(node.camera)];
        const glm::dmat4& world = tree.worldFromNode[i];
        Camera camera;
        camera.name = shown(source.name.empty() ? node.name : source.name);
        camera.orthographic = source.type == "orthographic";
        if (camera.orthographic) {
            camera.xmag = source.orthographic.xmag;
            camera.ymag = source.orthographic.ymag;
        } else {
            camera.yfov = source.perspective.yfov;
            camera.aspect = std::max(source.perspective.aspectRatio, 0.0);
        }
        // A camera looks along -z with +y up (glTF 2.0, 3.10.2); scale and mirroring do not reach the picture.
        camera.position = glm::dvec3(world[3]) - origin;
        camera.forward = unitOrZero(-glm::dvec3(world[2]));
        camera.right = unitOrZero(glm::cross(camera.forward, glm::dvec3(world[1])));
        camera.up = glm::cross(camera.right, camera.forward);
        if (camera.right == glm::dvec3(0) || !isPlaced(glm::dvec3(world[3]))) {
            warnings.add(fmt::format("Ignored the camera at nodes[{}]: its transform has no direction or place.", i));
            continue;
        }
        cameras.push_back(camera);
    }
    return cameras;
}

std::vector<PunctualLight> readLights(const Document& document, const NodeTree& tree, const glm::dvec3& origin,
                                      Warnings& warnings)
{
    std::vector<PunctualLight> lights;
    for (const uint32_t i : tree.visible) {
        const tinygltf::Node& node = document.model.nodes[i];
        const tinygltf::Value* use = findExtension(node.extensions, "KHR_lights_punctual");
        if (!use) continue;
        const tinygltf::Light& source = document.model.lights[static_cast<size_t>(use->Get("light").GetNumberAsInt())];
        const glm::dmat4& world = tree.worldFromNode[i];
        PunctualLight light;
        light.name = shown(source.name.empty() ? node.name : source.name);
        light.kind = source.type == "point"  ? LightKind::Point
                     : source.type == "spot" ? LightKind::Spot
                                             : LightKind::Directional;
        for (int c = 0; c < 3; ++c) {
            const double color = source.color.empty() ? 1 : source.color[static_cast<size_t>(c)];
            light.intensity[c] = static_cast<float>(
                clamped(color * source.intensity, 0, MAX_RADIANCE, "the intensity of a light", warnings));
        }
        if (light.kind == LightKind::Spot) {
            // Radians, of which directions in float32 resolve 1e-7. The falloff divides by the edge's width.
            constexpr double NARROWEST = 1e-5, WIDEST_INNER = 1 - 1e-4;
            const double outer = clamped(source.spot.outerConeAngle, NARROWEST, std::numbers::pi / 2,
                                         "the outer cone of a spot light", warnings);
            const double inner = clamped(source.spot.innerConeAngle, 0, outer * WIDEST_INNER,
                                         "the inner cone of a spot light", warnings);
            light.outerConeAngle = static_cast<float>(outer);
            light.innerConeAngle = static_cast<float>(inner);
        }
        const glm::dvec3 along = unitOrZero(-glm::dvec3(world[2])), position(world[3]);
        if ((light.kind != LightKind::Point && along == glm::dvec3(0)) || !isPlaced(position)) {
            warnings.add(fmt::format("Ignored the light at nodes[{}]: its transform has no direction or place.", i));
            continue;
        }
        if (light.kind != LightKind::Point) light.direction = glm::vec3(along);
        light.position = glm::vec3(position - origin);
        lights.push_back(std::move(light));
    }
    return lights;
}

} // namespace scene::gltf
