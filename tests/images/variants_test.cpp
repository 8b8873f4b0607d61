// What is compiled out must not be missed: a renderer with everything compiled in makes the same pictures.

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "passes/renderer.h"
#include "tests/support/gpu_fixture.h"
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
        return renderer.readMean();
    }
};

// Of each layout of the tables, and of each kind of light. What the compiler may reorder differs, and with it last
// bits; where such a bit decides (does this ray just miss an edge?) a pixel differs by a whole path: few may.
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
        for (size_t i = 0; i < needed.pixels.size(); ++i) {
            const glm::vec3 difference = glm::abs(needed.pixels[i] - everything.pixels[i]);
            different += glm::any(glm::greaterThan(difference, 4e-6f * needed.pixels[i]));
        }
        EXPECT_LE(different, needed.pixels.size() / 500) << test.name;
    }
    EXPECT_EQ(rendered, chosen.size());
}

} // namespace
} // namespace support
