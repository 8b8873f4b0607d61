#pragma once
// All light of a scene as table rows: one alias table over emissive triangles, punctual lights and the environment,
// picked by power (by the largest channel, so that permuting the colors permutes the picture and nothing else).

#include <vector>

#include "engine/scene/scene_tables.h"

namespace scene
{

struct LightTables {
    double radianceScale = 1;                   // power of two
    std::vector<glm::uvec4> lights;             // rows, see shaders/shared/scene.h
    std::vector<glm::uvec4> punctual;           // PUNCTUAL_ROWS each
    std::vector<glm::uvec4> environment;        // one row a texel
    std::vector<glm::uvec4> environmentAliases; // one row for two texels
    float environmentPick = 0;
    std::vector<uint32_t> lightOfTriangle; // NO_INDEX: not sampled by next-event estimation
    LightCounts counts;
};

// `positions` are scaled by lengthScale; `radius` is of the scaled scene.
LightTables makeLightTables(const Scene& scene, const std::vector<glm::vec3>& positions, double lengthScale,
                            double radius);

} // namespace scene
