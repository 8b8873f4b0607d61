#pragma once
// In how many places the meshes of a file stand, and which of them are stored once.

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/gltf_mesh_part.h"
#include "engine/scene/gltf_nodes.h"
#include "engine/scene/instances.h"

namespace scene::gltf
{

// EXT_mesh_gpu_instancing: translation, rotation and scale of each instance inside the node; else the node itself.
std::vector<glm::dmat4> instancesOf(MeshPartReader& reader, const tinygltf::Node& node, Warnings& warnings);
size_t instanceCount(MeshPartReader& reader, const tinygltf::Node& node);

bool isDrawable(const Document& document, const tinygltf::Primitive& primitive);
uint32_t materialOf(const tinygltf::Primitive& primitive, size_t materials); // of as many, the last being the default

// At most, before anything is read.
struct PrimitiveSize {
    uint64_t vertices = 0, triangles = 0;
};
PrimitiveSize sizeOf(const Document& document, const tinygltf::Primitive& primitive);

// By mesh of the file: those that stand in several places, keep their shape and do not emit. Auto: where copies are many.
std::vector<bool> chooseStoredOnce(const Document& document, const NodeTree& tree, MeshPartReader& reader,
                                   const std::vector<bool>& movesMesh, const std::vector<Material>& materials,
                                   Instancing instancing);

} // namespace scene::gltf
