#pragma once
// Small scenes that move, as a renderer is shown them: the same triangles, lights and materials in every frame,
// elsewhere.

#include <cstdint>
#include <vector>

#include "engine/scene/scene.h"

namespace support
{

struct MovingWorld {
    const char* name;
    scene::Scene (*at)(uint32_t frame); // frame 0 is the scene at rest
    uint32_t maxBounces = 3;
};
std::vector<MovingWorld> movingWorlds();

// The triangles from `first` on: each vertex where `place` takes it, with its normal. Triangles change the order of
// their corners where the transform mirrors.
void transform(scene::Scene& scene, size_t firstTriangle, size_t endTriangle, const glm::mat4& place);

// As scene::pose() hides what is not visible.
void hide(scene::Scene& scene, size_t firstTriangle, size_t endTriangle);

} // namespace support
