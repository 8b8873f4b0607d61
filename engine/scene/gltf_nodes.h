#pragma once
// The node hierarchy: world transforms, and what stands at them other than meshes.

#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/gltf_document.h"
#include "engine/scene/placing.h"
#include "engine/scene/scene.h"

namespace scene::gltf
{

struct NodeTree {
    std::vector<uint32_t> parents;         // of every node of the file; NONE: it is a root
    std::vector<uint32_t> order;           // every node, parents first
    std::vector<glm::dmat4> worldFromNode; // for every node of the file, float64
    std::vector<uint32_t> visible;         // the nodes of the default scene, parents first, each once
    std::vector<bool> hidden;              // for every node: KHR_node_visibility hides its mesh and light for good
};

NodeTree resolveNodes(const Document& document, Warnings& warnings);

// Of nodes[index]. Throws Error: a matrix that is not affine, a rotation that is zero.
Transform readTransform(const tinygltf::Node& node, size_t index, Warnings& warnings);

bool isVisible(const tinygltf::Node& node); // its own word alone

// Positions are those of the world: nothing is relative to Scene::origin yet.
struct WorldCamera {
    Camera camera;
    uint32_t node;
};
std::vector<WorldCamera> readCameras(const Document& document, const NodeTree& tree, Warnings& warnings);

struct WorldLight {
    PunctualLight light; // its position is not set
    glm::dvec3 position;
    uint32_t node;
    uint32_t source; // in the file's list of lights
    Lamp lamp;
};
std::vector<WorldLight> readLights(const Document& document, const NodeTree& tree, Warnings& warnings);

} // namespace scene::gltf
