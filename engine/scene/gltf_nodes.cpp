#include "engine/scene/gltf_nodes.h"

#include <cmath>

#include "engine/base/error.h"
#include "engine/scene/gltf_json.h"
#include "engine/scene/gltf_values.h"

namespace scene::gltf
{

namespace
{

std::vector<int> sceneRoots(const Document& document, const NodeTree& tree, Warnings& warnings)
{
    const tinygltf::Model& model = document.model;
    if (!model.scenes.empty()) {
        if (model.scenes.size() > 1 && model.defaultScene < 0)
            warnings.add("The file names no default scene: took the first.");
        return model.scenes[static_cast<size_t>(std::max(model.defaultScene, 0))].nodes;
    }
    if (!model.nodes.empty()) warnings.add("The file has no scene: took all its nodes.");
    std::vector<int> roots;
    for (const uint32_t i : tree.order)
        if (tree.parents[i] == NONE) roots.push_back(static_cast<int>(i));
    return roots;
}

} // namespace

Transform readTransform(const tinygltf::Node& node, size_t index, Warnings& warnings)
{
    Transform transform;
    if (!node.matrix.empty()) {
        glm::dmat4& matrix = transform.matrix.emplace();
        for (size_t i = 0; i < 16; ++i) matrix[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = node.matrix[i];
        if (matrix[0][3] != 0 || matrix[1][3] != 0 || matrix[2][3] != 0 || matrix[3][3] != 1)
            throw Error("nodes[{}].matrix is no affine transform: its last row must be 0 0 0 1.", index);
        return transform;
    }
    const auto vec3 = [](const std::vector<double>& v) { return glm::dvec3(v[0], v[1], v[2]); };
    if (!node.translation.empty()) transform.translation = vec3(node.translation);
    if (!node.rotation.empty()) {
        const auto& r = node.rotation; // x, y, z, w
        const glm::dquat rotation(r[3], r[0], r[1], r[2]);
        const double length = std::sqrt(glm::dot(rotation, rotation));
        if (!(length > 0)) throw Error("nodes[{}].rotation is zero, which is no rotation.", index);
        if (std::abs(length - 1) > 0.01) warnings.add("Normalized the rotation of a node.");
        transform.rotation = rotation / length;
    }
    if (!node.scale.empty()) transform.scale = vec3(node.scale);
    return transform;
}

bool isVisible(const tinygltf::Node& node)
{
    const tinygltf::Value* visibility = findExtension(node.extensions, "KHR_node_visibility");
    return !visibility || !visibility->Has("visible") || visibility->Get("visible").Get<bool>();
}

NodeTree resolveNodes(const Document& document, Warnings& warnings)
{
    // Iterative throughout: chains may be as long as the file.
    const auto& nodes = document.model.nodes;
    NodeTree tree;
    tree.parents.resize(nodes.size(), NONE);
    for (uint32_t i = 0; i < nodes.size(); ++i) {
        for (const int child : nodes[i].children) tree.parents[static_cast<size_t>(child)] = i;
    }
    for (uint32_t i = 0; i < nodes.size(); ++i) {
        if (tree.parents[i] == NONE) tree.order.push_back(i);
    }
    for (size_t i = 0; i < tree.order.size(); ++i) { // grows
        const std::vector<int>& children = nodes[tree.order[i]].children;
        tree.order.insert(tree.order.end(), children.begin(), children.end());
    }

    tree.worldFromNode.resize(nodes.size());
    tree.hidden.resize(nodes.size());
    const auto hides = [&](uint32_t i) {
        return !isVisible(nodes[i]) && !document.animations.moved.contains({Property::Visible, i});
    };
    for (const uint32_t i : tree.order) {
        const uint32_t parent = tree.parents[i];
        const glm::dmat4 parentFromNode = readTransform(nodes[i], i, warnings).toMatrix();
        tree.worldFromNode[i] = parent == NONE ? parentFromNode : tree.worldFromNode[parent] * parentFromNode;
        tree.hidden[i] = hides(i) || (parent != NONE && tree.hidden[parent]);
    }

    std::vector<bool> seen(nodes.size(), false);
    const std::vector<int> roots = sceneRoots(document, tree, warnings);
    std::vector<uint32_t> pending(roots.rbegin(), roots.rend());
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

std::vector<WorldCamera> readCameras(const Document& document, const NodeTree& tree, Warnings& warnings)
{
    std::vector<WorldCamera> cameras;
    for (const uint32_t i : tree.visible) {
        const tinygltf::Node& node = document.model.nodes[i];
        if (node.camera < 0) continue;
        const tinygltf::Camera& source = document.model.cameras[static_cast<size_t>(node.camera)];
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
        if (placeCamera(camera, tree.worldFromNode[i]))
            cameras.push_back({camera, i});
        else
            warnings.add(fmt::format("Ignored the camera at nodes[{}]: its transform has no direction or place.", i));
    }
    return cameras;
}

std::vector<WorldLight> readLights(const Document& document, const NodeTree& tree, Warnings& warnings)
{
    const Clamp clamp = [&](double value, double minimum, double maximum, const char* what) {
        return clamped(value, minimum, maximum, what, warnings);
    };
    std::vector<WorldLight> lights;
    for (const uint32_t i : tree.visible) {
        const tinygltf::Node& node = document.model.nodes[i];
        const tinygltf::Value* use = findExtension(node.extensions, "KHR_lights_punctual");
        if (!use || tree.hidden[i]) continue;
        WorldLight result{.node = i, .source = static_cast<uint32_t>(use->Get("light").GetNumberAsInt())};
        const tinygltf::Light& source = document.model.lights[result.source];
        PunctualLight& light = result.light;
        light.name = shown(source.name.empty() ? node.name : source.name);
        light.kind = source.type == "point"  ? LightKind::Point
                     : source.type == "spot" ? LightKind::Spot
                                             : LightKind::Directional;
        Lamp& lamp = result.lamp;
        if (!source.color.empty()) lamp.color = {source.color[0], source.color[1], source.color[2]};
        lamp.intensity = source.intensity;
        lamp.innerConeAngle = source.spot.innerConeAngle;
        lamp.outerConeAngle = source.spot.outerConeAngle;
        shine(light, lamp, clamp);
        const auto position = placeLight(light, tree.worldFromNode[i]);
        if (position) {
            result.position = *position;
            lights.push_back(std::move(result));
        } else {
            warnings.add(fmt::format("Ignored the light at nodes[{}]: its transform has no direction or place.", i));
        }
    }
    return lights;
}

} // namespace scene::gltf
