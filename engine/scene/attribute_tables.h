#pragma once
// Table "Attributes" (shaders/shared/scene.h): what shaders know of a triangle beside the tree.

#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "engine/scene/scene.h"

namespace scene
{

// The record of triangle `index`, as many rows as it has. `positions` are those of `scene`, scaled; `light`: its index,
// or shared::NO_INDEX.
void packAttributes(const Geometry& scene, std::span<const glm::vec3> positions, uint32_t light, size_t index,
                    std::span<glm::uvec4> record);

} // namespace scene
