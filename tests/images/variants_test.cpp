// What is compiled out must not be missed: a renderer with everything compiled in makes the same pictures.
// Covers engine/scene/material_tables.cpp, engine/scene/scene_tables.cpp.

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>

#include "passes/renderer.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/stored_meshes.h"
#include "tests/support/test_scenes.h"

namespace support
{
namespace
{

class Variants : public GpuTest
{
  protected:
    image::Image render(const TestScene& test, scene::FeatureSet features)
    {
        passes::Renderer renderer(device(), test.make(), test.settings(), {}, features);
        for (int i = 0; i < 2; ++i) renderer.renderFrame();
        return renderer.read(passes::MEAN);
    }
};

// Of each layout of the tables, and of each kind of light. What the compiler may reorder differs: some last bits do,
// and now and then one of them turns a decision (does this ray pass that edge?).
TEST_F(Variants, WithAndWithoutUnneededFeaturesRenderTheSame)
{
    const std::set<std::string> chosen = {"Lambert",   "FrostedGlass", "Textures",      "NormalMap",
                                          "AlphaMask", "Unlit",        "SeveralLights", "Orthographic"};
    size_t rendered = 0;
    for (const TestScene& test : testScenes()) {
        if (!chosen.contains(test.name)) continue;
        ++rendered;
        const image::Image needed = render(test, scene::FeatureSet::Needed);
        const image::Image everything = render(test, scene::FeatureSet::Everything);
        size_t different = 0;
        for (size_t i = 0; i < needed.pixels.size(); ++i)
            different += glm::distance(needed.pixels[i], everything.pixels[i]) > 4e-6f * glm::length(needed.pixels[i]);
        EXPECT_LE(different, 3u) << test.name;
    }
    EXPECT_EQ(rendered, chosen.size());
}

// Rounding differs, and with it now and then whether a ray passes an edge.
TEST_F(Variants, MeshesStoredOnceLookAsTheirCopiesDo)
{
    for (const TestScene& test : testScenes()) {
        const scene::Scene scene = test.make();
        if (scene.instances.empty()) continue;
        passes::Renderer stored(device(), scene, test.settings()), copied(device(), expanded(scene), test.settings());
        std::array<glm::dvec3, 2> sums = {};
        size_t different = 0;
        stored.renderFrame();
        copied.renderFrame();
        const image::Image a = stored.read(passes::MEAN), b = copied.read(passes::MEAN);
        for (size_t i = 0; i < a.pixels.size(); ++i) {
            different += glm::distance(a.pixels[i], b.pixels[i]) > 1e-3f * glm::length(b.pixels[i]);
            sums[0] += glm::dvec3(a.pixels[i]);
            sums[1] += glm::dvec3(b.pixels[i]);
        }
        EXPECT_LE(different, a.pixels.size() / 50) << test.name;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(sums[0][c] / sums[1][c], 1, 2e-3) << test.name;
    }
}

} // namespace
} // namespace support
