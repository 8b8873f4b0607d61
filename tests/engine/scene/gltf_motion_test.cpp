// What moves in a file, as loading finds it; tests/engine/scene/motion_test.cpp poses it.

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/scene/motion.h"
#include "tests/support/tiny_gltf.h"

namespace scene
{

// Its animation would show it, but cannot be played.
TEST(GltfMotion, WhatOnlyABrokenAnimationWouldShowStaysHidden)
{
    TinyGltf file;
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 8}}};
    file.json["nodes"] = {{{"children", {1, 2}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}},
                          {{"mesh", 0}},
                          {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
    file.animatePointer("/nodes/0/extensions/KHR_node_visibility/visible", {1, 0}, {1, 1}, "SCALAR", "STEP");
    const Scene scene = file.load();
    EXPECT_NE(scene.motion->animations[0].fault, "");
    ASSERT_EQ(scene.triangles.size(), 1u);
    EXPECT_EQ(scene.triangles[0].vertices, (std::array<uint32_t, 3>{}));
    EXPECT_EQ(scene.lights.at(0).intensity, glm::vec3(0));
}

// What is wrong with a mesh is said whether it moves or not.
TEST(GltfMotion, MeshesThatMoveGiveTheWarningsOfThoseThatDoNot)
{
    TinyGltf without, with;
    without.material()["normalTexture"]["index"] = without.texture({0, 0, 0, 0});
    without.attributes()["NORMAL"] = without.accessor<float>({0, 0, 0, 0, 0, 1, 0, 0, 0}, "VEC3");
    without.attributes()["COLOR_0"] = without.accessor<float>({2, 0, 0, 0, 0, -1, 0, std::nanf(""), 0}, "VEC3");
    with.material()["emissiveTexture"]["index"] = with.texture({0, 0, 0, 0});
    with.attributes()["TEXCOORD_0"] = with.accessor<float>({2e6f, 0, 0, std::nanf(""), 0, 0}, "VEC2");
    const std::vector<std::pair<TinyGltf*, std::vector<std::string>>> cases = {
        {&without,
         {"Clamped a vertex color to the range from 0 to 1 (3 times).",
          "meshes[0].primitives[0] has a texture but no texture coordinates for it.",
          "Replaced a normal that has no direction by that of the triangles (2 times)."}},
        {&with, {"Took 0 for a texture coordinate that is not finite or beyond 1e6 (2 times)."}}};
    for (const auto& [file, expected] : cases) {
        const Scene still = file->load();
        for (const std::string& sentence : expected) EXPECT_TRUE(file->warns(sentence)) << sentence;
        file->animate({{"node", 0}, {"path", "translation"}}, {0, 1}, {0, 0, 0, 0, 0, 2}, "VEC3");
        const Scene scene = file->load();
        EXPECT_EQ(scene.motion->parts.size(), 1u);
        EXPECT_EQ(scene.warnings, still.warnings);
    }
}

} // namespace scene
