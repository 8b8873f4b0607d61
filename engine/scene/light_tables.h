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
    double environmentPower = 0;                // of a scene of radius 1
    float environmentPick = 0;
    std::vector<uint32_t> lightOfTriangle; // NO_INDEX: not sampled by next-event estimation
    std::vector<double> emissiveMeans;     // by material: of its emissive texture's largest channel; 1: it has none
    LightCounts counts;
};

// `positions` are scaled by lengthScale; `radius` is of the scaled scene. `rest`: tables of another pose of the scene;
// what all have in common is kept as it is there, the environment's rows are left out.
LightTables makeLightTables(const Scene& scene, const std::vector<glm::vec3>& positions, double lengthScale,
                            double radius, const LightTables* rest = nullptr);

} // namespace scene
