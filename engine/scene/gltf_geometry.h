#pragma once
// Every mesh of the visible nodes, as triangles in the world.

#include <functional>

#include "engine/scene/gltf_nodes.h"
#include "engine/scene/scene.h"

namespace scene::gltf
{

// Fills origin, vertices and triangles of `scene`; Triangle::material counts scene.materials, whose last is the
// default. Throws Error: indices out of range, more geometry than fits, coordinates too far apart for float32.
void readGeometry(const Document& document, const NodeTree& tree, Scene& scene, Warnings& warnings,
                  const std::function<void(double)>& progress);

} // namespace scene::gltf
