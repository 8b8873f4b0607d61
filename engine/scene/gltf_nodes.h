#pragma once
// The node hierarchy: world transforms, and what stands at them other than meshes.

#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/gltf_document.h"
#include "engine/scene/scene.h"

namespace scene::gltf
{

struct NodeTree {
    std::vector<glm::dmat4> worldFromNode; // for every node of the file, float64
    std::vector<uint32_t> visible;         // the nodes of the default scene, parents first, each once
};

NodeTree resolveNodes(const Document& document, Warnings& warnings);

// Positions are those of the world: nothing is relative to Scene::origin yet.
std::vector<Camera> readCameras(const Document& document, const NodeTree& tree, Warnings& warnings);

struct WorldLight {
    PunctualLight light; // its position is not set
    glm::dvec3 position;
};
std::vector<WorldLight> readLights(const Document& document, const NodeTree& tree, Warnings& warnings);

} // namespace scene::gltf
