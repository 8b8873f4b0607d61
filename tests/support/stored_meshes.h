#pragma once
// Meshes that are stored once, made and undone.

#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/scene.h"

namespace support
{

// The triangles of a material become a mesh, which stands in these places instead.
scene::Scene storedOnce(scene::Scene scene, uint32_t material, const std::vector<glm::dmat4>& places);

// The same world: they stay where they are, in a space of their own.
scene::Scene storedInPlace(scene::Scene scene, uint32_t material, const glm::dmat4& place);

// The scene with a copy of its mesh for each visible instance and no instances: the same world, flat.
scene::Scene expanded(const scene::Scene& scene);

} // namespace support
