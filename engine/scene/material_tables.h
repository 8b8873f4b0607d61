#pragma once
// Materials and textures as table rows, and which features they use. See shaders/shared/scene.h for the layout.

#include <vector>

#include "engine/scene/scene_tables.h"

namespace scene
{

struct MaterialTables {
    std::vector<glm::uvec4> rows;   // MATERIAL_ROWS each, of SceneData
    std::vector<glm::uvec4> texels; // table Texels: 2x2 blocks of RGBA8 or RGBA16
    SceneFeatures features;         // of the materials that triangles use; light kinds are left false
};

// With `moves`, the features are those of all that Scene::motion may make of the materials.
MaterialTables makeMaterialTables(const Scene& scene, double radianceScale, bool moves = false);

// The rows of another pose: textures and what they are used for stay.
std::vector<glm::uvec4> repaint(std::vector<glm::uvec4> rows, const Scene& scene, double radianceScale);

} // namespace scene
