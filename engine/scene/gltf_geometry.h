#pragma once
// Every mesh of the visible nodes, as triangles in the world, or stored once and placed there.

#include <functional>

#include "engine/scene/gltf_motion.h"
#include "engine/scene/instances.h"
#include "engine/scene/scene.h"

namespace scene::gltf
{

// Also plans what moves, and adds its parts. Fills origin, vertices, triangles, meshes and instances of `scene`;
// Triangle::material counts scene.materials, whose last is the default. Throws Error: indices out of range, more
// geometry than fits, coordinates too far apart for float32.
MotionPlan readGeometry(const Document& document, const NodeTree& tree, Scene& scene, Instancing instancing,
                        Warnings& warnings, const std::function<void(double)>& progress);

} // namespace scene::gltf
