#pragma once
// In how many places the meshes of a file stand, and which of them are stored once.

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/gltf_motion.h"
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

// Which meshes of a file are stored once, and where: those that stand in several places and do not emit.
class StoredOnce
{
  public:
    // Auto: where copies are many. On: also a mesh in one place, if that moves.
    StoredOnce(const Document& document, const NodeTree& tree, MeshPartReader& reader, const MotionPlan& plan,
               const std::vector<Material>& materials, Instancing instancing);
    bool is(size_t mesh) const { return chosen_[mesh]; }
    bool standsAt(uint32_t node) const { return mayStand_[node] && is(static_cast<size_t>(meshOf_[node])); }

  private:
    std::vector<bool> chosen_;   // by mesh
    std::vector<bool> mayStand_; // by node
    std::vector<int> meshOf_;    // by node
};

} // namespace scene::gltf
