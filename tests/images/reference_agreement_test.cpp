// The path tracer on the device against the float64 reference: pictures of small scenes, tile by tile and as a whole.

#include <gtest/gtest.h>

#include "tests/support/gpu_fixture.h"
#include "tests/support/gpu_pictures.h"
#include "tests/support/reference_tracer.h"
#include "tests/support/test_scenes.h"

namespace support
{
namespace
{

constexpr uint32_t FRAMES = 600;
constexpr uint64_t REFERENCE_SAMPLES = 600; // per pixel
constexpr uint64_t REFERENCE_SEED = 1;

PictureEstimates expectedOf(const scene::Scene& scene, const passes::Settings& settings)
{
    return pictureOf(reference(scene, settings, REFERENCE_SAMPLES, REFERENCE_SEED));
}

PictureEstimates scaled(PictureEstimates picture, double factor)
{
    for (TileEstimates* estimates : {&picture.tiles, &picture.whole})
        for (auto& tile : estimates->tiles)
            for (Estimate& e : tile) e = {factor * e.mean, factor * factor * e.varianceOfMean, e.degreesOfFreedom};
    return picture;
}

class ReferenceAgreement : public GpuTest, public testing::WithParamInterface<TestScene>
{
};

TEST_P(ReferenceAgreement, ByTilesAndAsAWhole)
{
    const scene::Scene scene = GetParam().make();
    const PictureEstimates rendered = renderFrames(device(), scene, GetParam().settings(), FRAMES);
    const PictureEstimates expected = expectedOf(scene, GetParam().settings());
    const TileVerdict verdict = picturesAgree(rendered, expected);
    EXPECT_TRUE(verdict.passes) << verdict.summary;
    // So precise that an error of 2% would have been seen.
    EXPECT_FALSE(picturesAgree(rendered, scaled(expected, 1.02)).passes);
    EXPECT_FALSE(picturesAgree(rendered, scaled(expected, 0.98)).passes);
}

INSTANTIATE_TEST_SUITE_P(Of, ReferenceAgreement, testing::ValuesIn(testScenes()),
                         [](const auto& i) { return i.param.name; });

// A reference with one wrong parameter must disagree.
struct PlantedError {
    const char* name;
    const char* scene;
    void (*plant)(scene::Scene&, passes::Settings&);
};
void PrintTo(const PlantedError& error, std::ostream* os)
{
    *os << error.name;
}

class PlantedErrors : public GpuTest, public testing::WithParamInterface<PlantedError>
{
};

TEST_P(PlantedErrors, AreFound)
{
    for (const TestScene& test : testScenes()) {
        if (test.name != std::string(GetParam().scene)) continue;
        scene::Scene scene = test.make();
        passes::Settings settings = test.settings();
        const PictureEstimates rendered = renderFrames(device(), scene, settings, FRAMES);
        GetParam().plant(scene, settings);
        const TileVerdict verdict = picturesAgree(rendered, expectedOf(scene, settings));
        EXPECT_FALSE(verdict.passes) << verdict.summary;
        return;
    }
    FAIL() << "there is no scene " << GetParam().scene;
}

void brighten(scene::Material& material)
{
    material.baseColor *= glm::vec4(1.02f, 1.02f, 1.02f, 1);
}

INSTANTIATE_TEST_SUITE_P(
    Of, PlantedErrors,
    testing::Values(
        PlantedError{"WallsBrighter", "Room", [](auto& s, auto&) { brighten(s.materials[0]); }},
        PlantedError{"MetalBrighter", "Mirror", [](auto& s, auto&) { brighten(s.materials[1]); }},
        PlantedError{"GlassBrighter", "FrostedGlass", [](auto& s, auto&) { brighten(s.materials[1]); }},
        PlantedError{"LampStronger", "TwoSidedLamp", [](auto& s, auto&) { s.materials[1].emission *= 1.02f; }},
        PlantedError{"PointStronger", "PointLight", [](auto& s, auto&) { s.lights[0].intensity *= 1.02f; }},
        PlantedError{"SunStronger", "SunnySky", [](auto& s, auto&) { s.environment.radiance[4 * 32 + 5] *= 1.02f; }},
        PlantedError{"ConeWider", "SpotLight", [](auto& s, auto&) { s.lights[0].outerConeAngle *= 1.02f; }},
        PlantedError{"Rougher", "RoughMetal", [](auto& s, auto&) { s.materials[1].roughness *= 1.1f; }},
        PlantedError{"IndexHigher", "ClearGlass", [](auto& s, auto&) { s.materials[1].ior *= 1.1f; }},
        PlantedError{"CoverageHigher", "AlphaBlend", [](auto& s, auto&) { s.materials[1].baseColor.a *= 1.1f; }},
        PlantedError{"BumpsHigher", "NormalMap", [](auto& s, auto&) { s.materials[1].normalScale *= 1.5f; }},
        PlantedError{"TextureShifted", "Textures",
                     [](auto& s, auto&) { s.materials[1].baseColorTexture.row0.z += 0.02f; }},
        PlantedError{"DeepTexelsDarker", "DeepTextures",
                     [](auto& s, auto&) {
                         for (uint16_t& sample : s.images[1].deep) sample = uint16_t(sample * 0.95);
                     }},
        PlantedError{"OneEventLess", "Room", [](auto&, auto& settings) { --settings.maxBounces; }}),
    [](const auto& i) { return i.param.name; });

} // namespace
} // namespace support
