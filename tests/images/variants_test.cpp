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
    image::Image render(const TestScene& test, passes::Renderer::Features features)
    {
        passes::Renderer renderer(device(), test.make(), test.settings(), {}, features);
        for (int i = 0; i < 2; ++i) renderer.renderFrame();
        return renderer.readMean();
    }
};

// Of each layout of the tables, and of each kind of light. What the compiler may reorder differs: some last bits do.
TEST_F(Variants, WithAndWithoutUnneededFeaturesRenderTheSame)
{
    const std::set<std::string> chosen = {"Lambert",   "FrostedGlass", "Textures",      "NormalMap",
                                          "AlphaMask", "Unlit",        "SeveralLights", "Orthographic"};
    size_t rendered = 0;
    for (const TestScene& test : testScenes()) {
        if (!chosen.contains(test.name)) continue;
        ++rendered;
        const image::Image needed = render(test, passes::Renderer::Features::Needed);
        const image::Image everything = render(test, passes::Renderer::Features::Everything);
        for (size_t i = 0; i < needed.pixels.size(); ++i)
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(needed.pixels[i][c], everything.pixels[i][c], 4e-6f * needed.pixels[i][c])
                    << test.name << ", pixel " << i;
    }
    EXPECT_EQ(rendered, chosen.size());
}

} // namespace
} // namespace support
