// What is compiled out must not be missed: a renderer with everything compiled in makes the same pictures.
// Covers engine/scene/material_tables.cpp, engine/scene/scene_tables.cpp.

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>

#include "passes/renderer.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/planted_shaders.h"
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
        passes::Renderer renderer(device(), test.make(), test.settings(), {.featureSet = features});
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

// Of a frame with meshes stored once, beside one with copies of them.
struct Beside {
    double different = 0;         // share of pixels that are
    glm::dvec3 ratio = {1, 1, 1}; // of the sums
};
Beside storedBesideCopies(gpu::Device& device, const TestScene& test)
{
    const scene::Scene scene = test.make();
    passes::Renderer stored(device, scene, test.settings()), copied(device, expanded(scene), test.settings());
    stored.renderFrame();
    copied.renderFrame();
    const image::Image a = stored.read(passes::MEAN), b = copied.read(passes::MEAN);
    Beside beside;
    glm::dvec3 sumA(0), sumB(0);
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        beside.different += glm::distance(a.pixels[i], b.pixels[i]) > 1e-3f * glm::length(b.pixels[i]);
        sumA += glm::dvec3(a.pixels[i]);
        sumB += glm::dvec3(b.pixels[i]);
    }
    beside.different /= double(a.pixels.size());
    beside.ratio = sumA / sumB;
    return beside;
}

// Rounding differs, and with it now and then whether a ray passes an edge.
TEST_F(Variants, MeshesStoredOnceLookAsTheirCopiesDo)
{
    size_t compared = 0;
    for (const TestScene& test : testScenes()) {
        if (test.make().instances.empty()) continue;
        ++compared;
        const auto [different, ratio] = storedBesideCopies(device(), test);
        EXPECT_LE(different, 0.02) << test.name;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(ratio[c], 1, 2e-3) << test.name;
    }
    EXPECT_EQ(compared, 3u);
}

TEST_F(Variants, ErrorsInMeshesStoredOnceAreFound)
{
    const std::pair<const char*, PlantedError> cases[] = {
        {"GlassCopies",
         {"MirrorForgotten", "scene/surface.glsl", "(last.x & INSTANCE_MIRRORS) != 0u ? -1.0 : 1.0", "1.0"}},
        {"Copies", {"NormalsAsPoints", "scene/surface.glsl", "(cofactors * normal)", "(m * normal)"}},
        {"MaskedCopies", {"FirstTriangle", "scene/surface.glsl", "& ((1u << scene.triangleBits) - 1u)", "& 0u"}}};
    for (const auto& [name, error] : cases) {
        PlantedShaders shaders(error.name);
        shaders.plant(error);
        gpu::Device planted = openDevice({.shaderDirectory = shaders.folder().string()});
        for (const TestScene& test : testScenes()) {
            if (std::string(test.name) != name) continue;
            EXPECT_GT(storedBesideCopies(planted, test).different, 0.02) << error.name;
        }
    }
}

} // namespace
} // namespace support
