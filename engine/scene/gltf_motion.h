#pragma once
// What moves in a file: found before its meshes are read, completed when the flat scene is there.

#include <cstdint>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "engine/scene/gltf_mesh_part.h"
#include "engine/scene/gltf_nodes.h"
#include "engine/scene/motion.h"

namespace scene::gltf
{

struct MotionPlan {
    std::shared_ptr<Motion> motion; // none: the file has no animations, and nothing else here counts
    std::vector<uint32_t> nodeOf;   // of Motion::nodes, by node of the file; NONE: it stands still
    std::vector<uint32_t> skinOf;   // of Motion::skins, by skin of the file; NONE: no mesh that moves has it
    std::vector<bool> movesMesh;    // by node of the file: its mesh belongs to Motion::parts
    std::map<std::tuple<int, size_t, size_t>, uint32_t>
        meshOf; // of Motion::meshes, by mesh, primitive, count of joints
};

// Animations, and the nodes and skins that they move. Throws Error.
MotionPlan planMotion(const Document& document, const NodeTree& tree, MeshPartReader& reader, Warnings& warnings);

// A primitive of nodes[node] joins Motion::parts; its mesh is read unless another part has it. `part` says which
// primitive it is (its name) and where it will lie in the flat scene. Returns its vertices and triangles at rest; some
// of these may not be finite, with a warning.
MeshPart addPart(MotionPlan& plan, const Document& document, MeshPartReader& reader, size_t primitive, uint32_t node,
                 const Placement& placement, Motion::Part part, const Material& material);

// Of a plan with a motion: lights, cameras and materials, and what the channels move among all of it. What the scene
// does not have, none moves. `materialOf` says where materials of the file are in the scene, or NONE; the scene's are
// as the file states them.
void completeMotion(MotionPlan& plan, const Document& document, const std::vector<WorldCamera>& cameras,
                    const std::vector<WorldLight>& lights, const std::vector<uint32_t>& materialOf, Scene& scene);

} // namespace scene::gltf
