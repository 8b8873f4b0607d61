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

// Relative to `origin`, which is Scene::origin.
std::vector<Camera> readCameras(const Document& document, const NodeTree& tree, const glm::dvec3& origin,
                                Warnings& warnings);
std::vector<PunctualLight> readLights(const Document& document, const NodeTree& tree, const glm::dvec3& origin,
                                      Warnings& warnings);

} // namespace scene::gltf
