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
    std::vector<uint32_t> emitters;        // triangles that are lights in some pose, the first of all lights
    std::vector<uint32_t> lightOfTriangle; // NO_INDEX: not sampled by next-event estimation
    std::vector<double> emissiveMeans;     // by material: of its emissive texture's largest channel; 1: it has none
    bool shine = false;                    // whether any of the lights does
    LightCounts counts;
};

// `positions` are scaled by lengthScale; `radius` is of the scaled scene. With `moves`, what may shine in another pose
// is a light, too, of power 0.
LightTables makeLightTables(const Scene& scene, const std::vector<glm::vec3>& positions, double lengthScale,
                            double radius, bool moves = false);

// Of another pose, without what all have in common: scale, rows of the environment, which triangles are lights.
LightTables makeLightTables(const Scene& posed, const std::vector<glm::vec3>& positions, double lengthScale,
                            double radius, const LightTables& rest);

} // namespace scene
