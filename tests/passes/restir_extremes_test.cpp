// ReSTIR's numbers stay sound where scenes and settings are extreme: everything finite, nothing drifts.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "engine/scene/shapes.h"
#include "passes/camera_path.h"
#include "passes/renderer.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/test_scenes.h"

namespace
{

struct Extreme {
    const char* name;
    std::function<scene::Scene()> make;
};
void PrintTo(const Extreme& extreme, std::ostream* os)
{
    *os << extreme.name;
}

scene::Scene rough(float roughness, float metallic)
{
    return support::ballOf({.baseColor = {0.9f, 0.6f, 0.4f, 1}, .metallic = metallic, .roughness = roughness});
}

// A lamp besides those of the ball's scene.
scene::Scene withLamp(const glm::vec3& radiance, const glm::vec3& corner, const glm::vec3& edge0,
                      const glm::vec3& edge1)
{
    scene::Scene scene = rough(0.5f, 0);
    scene::addQuad(scene, scene::addMaterial(scene, scene::emitter("extreme", radiance)), corner, edge0, edge1);
    return scene;
}

const Extreme EXTREMES[] = {
    {"BrightBesideDim",
     [] {
         return withLamp(glm::vec3(1e6f), {1.5f, 0.2f, 0.5f}, {0.1f, 0, 0}, {0, 0.1f, 0});
     }},
    {"DimBesideBright",
     [] {
         return withLamp(glm::vec3(1e-6f), {1.5f, 0.2f, 0.5f}, {0.1f, 0, 0}, {0, 0.1f, 0});
     }},
    {"OneChannel",
     [] {
         return withLamp({0, 0, 1e3f}, {1.5f, 0.2f, 0.5f}, {0.1f, 0, 0}, {0, 0.1f, 0});
     }},
    {"ThinEmitter",
     [] {
         return withLamp(glm::vec3(1e4f), {1.5f, 0.2f, 0.5f}, {1e-4f, 0, 0}, {0, 1, 0});
     }},
    {"EmitterOnTheFloor",
     [] {
         return withLamp(glm::vec3(10), {1.2f, 1e-5f, 0.5f}, {0.3f, 0, 0}, {0, 0, 0.3f});
     }},
    {"RoughnessZero", [] { return rough(0, 1); }},
    {"RoughnessTiny", [] { return rough(1e-4f, 1); }},
    {"RoughnessJustNotAMirror", [] { return rough(0.0157f, 1); }},
    {"RoughnessOne", [] { return rough(1, 0); }},
};

class RestirExtremes : public RendererFixture, public testing::WithParamInterface<Extreme>
{
};

} // namespace

TEST_P(RestirExtremes, AreFinite)
{
    const scene::Scene scene = GetParam().make();
    const passes::CameraAt cameraAt = passes::cameraOrbit(scene.cameras.at(0), 2);
    for (const passes::Shift shift : {passes::Shift::Reconnection, passes::Shift::Hybrid}) {
        passes::Settings settings;
        settings.width = 33; // no multiple of a workgroup
        settings.height = 17;
        settings.method = passes::Method::RgbRestir;
        settings.shift = shift;
        settings.spatialRadius = 4;
        settings.maxConfidence = 1u << 20;
        passes::Renderer renderer(device(), scene, settings);
        double sum = 0;
        for (uint64_t frame = 0; frame < 24; ++frame) {
            renderer.setCamera(cameraAt(frame));
            renderer.renderFrame();
            for (const glm::vec3& pixel : renderer.read(passes::LAST_FRAME).pixels) {
                ASSERT_TRUE(std::isfinite(pixel.r + pixel.g + pixel.b) && pixel.r >= 0 && pixel.g >= 0 && pixel.b >= 0);
                sum += double(pixel.r) + pixel.g + pixel.b;
            }
        }
        EXPECT_GT(sum, 0);
        for (const auto& [stage, count] : renderer.stats().nonFinite) EXPECT_EQ(count, 0u) << stage;
    }
}

INSTANTIATE_TEST_SUITE_P(Of, RestirExtremes, testing::ValuesIn(EXTREMES), [](const auto& i) { return i.param.name; });

using RestirDrift = RestirExtremes;

// M_c = 2^20: after thousands of frames the reservoirs still hold the mean of all frames, which the film sums with
// care. TRICHROME_TEST_DRIFT_FRAMES asks for more of them.
TEST_F(RestirDrift, StaysBelowAMillionth)
{
    const char* asked = std::getenv("TRICHROME_TEST_DRIFT_FRAMES");
    const uint64_t frames = asked ? std::stoull(asked) : 4000;
    const scene::Scene scene = rough(0.5f, 0);
    passes::Settings settings;
    settings.width = settings.height = 8;
    settings.maxBounces = 2;
    settings.shift = passes::Shift::Replay;
    settings.spatial = 0;
    settings.maxConfidence = 1u << 20;
    const auto pictureOf = [&](passes::Method method) {
        settings.method = method;
        settings.average = method == passes::Method::Pt;
        passes::Renderer renderer(device(), scene, settings);
        for (uint64_t i = 0; i < frames; ++i) renderer.renderFrame();
        return renderer.read(passes::colorOf(renderer.settings())).pixels;
    };
    const std::vector<glm::vec3> mean = pictureOf(passes::Method::Pt),
                                 reservoirs = pictureOf(passes::Method::RgbRestir);
    double worst = 0;
    for (size_t p = 0; p < mean.size(); ++p)
        for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(double(reservoirs[p][c]) / mean[p][c] - 1));
    std::printf("after %llu frames the worst pixel is off by %.2g\n", static_cast<unsigned long long>(frames), worst);
    EXPECT_LT(worst, 1e-6);
}
