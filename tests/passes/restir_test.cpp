// What ReSTIR owes exactly, not only in the mean: identities with the path tracer's own frames, and symmetries to the
// bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/base/statistics.h"
#include "passes/camera_path.h"
#include "passes/renderer.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/test_scenes.h"

namespace
{

using passes::Method;
using passes::Renderer;
using passes::Settings;
using passes::Shift;
using Pixels = std::vector<glm::vec3>;

constexpr glm::vec3 LUMINANCE(0.2126f, 0.7152f, 0.0722f);

class RestirTest : public GpuTest
{
  protected:
    void SetUp() override
    {
        GpuTest::SetUp();
        if (!IsSkipped() && device().adapter().name.find("SwiftShader") != std::string::npos)
            GTEST_SKIP() << "SKIPPED ON SwiftShader: compiling one renderer takes minutes there";
    }

    static scene::Scene sceneNamed(const std::string& name)
    {
        for (const support::TestScene& test : support::testScenes())
            if (test.name == name) return test.make();
        throw std::invalid_argument(name);
    }

    // Temporal reuse alone, of a resting camera, replayed.
    static Settings resting(Method method)
    {
        Settings s;
        s.width = s.height = 32;
        s.maxBounces = 3;
        s.method = method;
        s.shift = Shift::Replay;
        s.spatial = 0;
        s.maxConfidence = 1u << 20;
        s.average = false;
        return s;
    }

    // The last of some frames with all kinds of reuse, from a moving camera.
    Pixels moving(const scene::Scene& scene, Method method, Shift shift)
    {
        Settings s = resting(method);
        s.shift = shift;
        s.spatial = 2;
        s.spatialRadius = 4;
        s.maxConfidence = 16;
        Renderer renderer(device(), scene, s);
        const passes::CameraAt cameraAt = passes::cameraOrbit(scene.cameras.at(0), 2);
        for (uint64_t frame = 0; frame < 4; ++frame) {
            renderer.setCamera(cameraAt(frame));
            renderer.renderFrame();
        }
        for (const auto& [stage, count] : renderer.stats().nonFinite) EXPECT_EQ(count, 0u) << stage;
        return renderer.readFrame().pixels;
    }

    // The path tracer's frames one by one.
    std::vector<Pixels> pathTraced(const scene::Scene& scene, int frames)
    {
        Renderer renderer(device(), scene, resting(Method::Pt));
        std::vector<Pixels> list;
        for (int i = 0; i < frames; ++i) {
            renderer.renderFrame();
            list.push_back(renderer.readFrame().pixels);
        }
        return list;
    }
};

glm::dvec3 meanOver(const std::vector<Pixels>& frames, size_t count, size_t pixel)
{
    glm::dvec3 sum(0);
    for (size_t i = 0; i < count; ++i) sum += glm::dvec3(frames[i][pixel]);
    return sum / double(count);
}

// A color of every kind a scene holds.
void recolor(scene::Scene& scene, const std::function<glm::vec3(glm::vec3)>& change)
{
    for (scene::Material& m : scene.materials) {
        m.baseColor = glm::vec4(change(glm::vec3(m.baseColor)), m.baseColor.w);
        m.emission = change(m.emission);
        m.specularColor = change(m.specularColor);
    }
    for (auto& light : scene.lights) light.intensity = change(light.intensity);
    for (glm::vec3& radiance : scene.environment.radiance) radiance = change(radiance);
}

} // namespace

// A resting camera and replay: every frame's reservoirs are the mean of all the path tracer's frames so far.
TEST_F(RestirTest, RgbIsTheRunningMeanOfThePathTracer)
{
    constexpr int FRAMES = 24;
    for (const char* name : {"Glossy", "SunnySky"}) {
        const scene::Scene scene = sceneNamed(name);
        const std::vector<Pixels> traced = pathTraced(scene, FRAMES);
        for (const scene::FeatureSet features : {scene::FeatureSet::Needed, scene::FeatureSet::Everything}) {
            Renderer renderer(device(), scene, resting(Method::RgbRestir), {}, features);
            for (int i = 0; i < FRAMES; ++i) renderer.renderFrame();
            const Pixels picture = renderer.readFrame().pixels;
            size_t wrong = 0;
            for (size_t p = 0; p < picture.size(); ++p) {
                const glm::dvec3 mean = meanOver(traced, FRAMES, p);
                for (int c = 0; c < 3; ++c) wrong += !(std::abs(picture[p][c] - mean[c]) <= 1e-4 * mean[c]);
            }
            // With everything compiled in, last bits and with them single decisions differ
            // (tests/images/variants_test.cpp).
            EXPECT_LE(wrong, features == scene::FeatureSet::Needed ? 0 : 3 * picture.size() / 1000) << name;
        }
    }
}

// The same of hybrid shifts that are really made, each of them home: identities, and defined, on diffuse, glossy and
// glass vertices. At a grazing joint the density is evaluated for a slightly other direction: up to 1e-3 in single
// pixels.
TEST_F(RestirTest, HybridShiftsHomeAreIdentities)
{
    constexpr int FRAMES = 8;
    for (const char* name : {"Glossy", "FrostedGlass"}) {
        const scene::Scene scene = sceneNamed(name);
        const std::vector<Pixels> traced = pathTraced(scene, FRAMES);
        Settings settings = resting(Method::RgbRestir);
        settings.shift = Shift::Hybrid;
        Renderer renderer(device(), scene, settings, {}, scene::FeatureSet::Everything);
        for (int i = 0; i < FRAMES; ++i) renderer.renderFrame();
        const Pixels picture = renderer.readFrame().pixels;
        size_t wrong = 0;
        for (size_t p = 0; p < picture.size(); ++p) {
            const glm::dvec3 mean = meanOver(traced, FRAMES, p);
            for (int c = 0; c < 3; ++c) wrong += !(std::abs(picture[p][c] - mean[c]) <= 1e-4 * mean[c]);
        }
        EXPECT_LE(wrong, 3 * picture.size() / 1000) << name; // single decisions differ with everything compiled in
    }
}

// The same of luminance; single channels are left to chance.
TEST_F(RestirTest, LuminanceIsTheRunningMeanOfThePathTracersLuminance)
{
    constexpr int FRAMES = 16;
    scene::Scene scene = sceneNamed("SunnySky");
    const std::vector<Pixels> traced = pathTraced(scene, FRAMES);
    Renderer renderer(device(), scene, resting(Method::RestirPt));
    for (int i = 0; i < FRAMES; ++i) renderer.renderFrame();
    const Pixels picture = renderer.readFrame().pixels;
    size_t otherChannels = 0;
    for (size_t p = 0; p < picture.size(); ++p) {
        const glm::dvec3 mean = meanOver(traced, FRAMES, p);
        const double expected = glm::dot(mean, glm::dvec3(LUMINANCE));
        EXPECT_NEAR(glm::dot(glm::dvec3(picture[p]), glm::dvec3(LUMINANCE)), expected, 1e-4 * expected) << p;
        otherChannels += std::abs(picture[p].r - mean.r) > 0.01 * mean.r;
    }
    EXPECT_GT(otherChannels, picture.size() / 10); // else there was nothing to prove
}

// Beyond M_c the mean becomes an exponential one: S_n = S_(n-1) + (F_n - S_(n-1)) / (M_c + 1).
TEST_F(RestirTest, ConfidenceIsCapped)
{
    constexpr int FRAMES = 20;
    constexpr int MAX_CONFIDENCE = 3;
    const scene::Scene scene = sceneNamed("Glossy");
    const std::vector<Pixels> traced = pathTraced(scene, FRAMES);
    Settings settings = resting(Method::RgbRestir);
    settings.maxConfidence = MAX_CONFIDENCE;
    Renderer renderer(device(), scene, settings);
    for (int i = 0; i < FRAMES; ++i) renderer.renderFrame();
    const Pixels picture = renderer.readFrame().pixels;
    for (size_t p = 0; p < picture.size(); ++p) {
        glm::dvec3 expected(0);
        for (int i = 0; i < FRAMES; ++i)
            expected += (glm::dvec3(traced[size_t(i)][p]) - expected) / double(std::min(i, MAX_CONFIDENCE) + 1);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture[p][c], expected[c], 1e-4 * expected[c]) << p;
    }
}

TEST_F(RestirTest, WithoutReuseIsThePathTracer)
{
    const scene::Scene scene = sceneNamed("Glossy");
    const std::vector<Pixels> traced = pathTraced(scene, 2);
    Settings settings = resting(Method::RgbRestir);
    settings.temporal = false;
    for (const Shift shift : {Shift::Replay, Shift::Hybrid}) {
        settings.shift = shift;
        Renderer renderer(device(), scene, settings);
        renderer.renderFrame();
        renderer.renderFrame();
        const Pixels picture = renderer.readFrame().pixels;
        for (size_t p = 0; p < picture.size(); ++p)
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture[p][c], traced[1][p][c], 4e-6 * traced[1][p][c]) << p;
    }
}

TEST_F(RestirTest, PermutedChannelsPermuteThePicture)
{
    for (const Shift shift : {Shift::Replay, Shift::Hybrid}) {
        scene::Scene scene = sceneNamed("ManyLamps");
        const Pixels straight = moving(scene, Method::RgbRestir, shift);
        recolor(scene, [](glm::vec3 c) { return glm::vec3(c.b, c.r, c.g); });
        const Pixels permuted = moving(scene, Method::RgbRestir, shift);
        for (size_t p = 0; p < straight.size(); ++p)
            EXPECT_EQ(permuted[p], glm::vec3(straight[p].b, straight[p].r, straight[p].g)) << p;
    }
}

TEST_F(RestirTest, GreyScenesHaveEqualChannels)
{
    scene::Scene scene = sceneNamed("Glossy");
    recolor(scene, [](glm::vec3 c) { return glm::vec3(c.g); });
    for (const glm::vec3& pixel : moving(scene, Method::RgbRestir, Shift::Hybrid))
        EXPECT_TRUE(pixel.r == pixel.g && pixel.g == pixel.b);
}

TEST_F(RestirTest, PureRedLightLeavesTheOthersAtZero)
{
    scene::Scene scene = sceneNamed("Glossy");
    for (scene::Material& m : scene.materials) m.emission = {m.emission.r, 0, 0};
    for (glm::vec3& radiance : scene.environment.radiance) radiance = {radiance.r, 0, 0};
    double red = 0;
    for (const glm::vec3& pixel : moving(scene, Method::RgbRestir, Shift::Hybrid)) {
        red += pixel.r;
        EXPECT_EQ(pixel.g, 0.0f);
        EXPECT_EQ(pixel.b, 0.0f);
    }
    EXPECT_GT(red, 1);
}

TEST_F(RestirTest, LightTimesAPowerOfTwoIsThePictureTimesIt)
{
    scene::Scene scene = sceneNamed("SunnySky");
    const Pixels before = moving(scene, Method::RgbRestir, Shift::Hybrid);
    constexpr float SCALE = 1.0f / 1024;
    for (scene::Material& m : scene.materials) m.emission *= SCALE;
    for (glm::vec3& radiance : scene.environment.radiance) radiance *= SCALE;
    const Pixels after = moving(scene, Method::RgbRestir, Shift::Hybrid);
    for (size_t p = 0; p < before.size(); ++p) EXPECT_EQ(after[p], SCALE * before[p]) << p;
}

// The paper's law in closed form, for trees of one path (point lights, one scattering event), temporal reuse alone:
// autocovariance between frames n-1 and n is sigma^2 / n for RGB, and sigma^2 / n + (n - 2) / n V for luminance, with
// V = E[Y] E[f_c^2 / Y] - E[f_c]^2, Y the luminance of a frame's path.
TEST_F(RestirTest, AutocovarianceFollowsTheClosedForm)
{
    constexpr int RUNS = 96;
    constexpr int FRAMES = 128;
    scene::Scene scene = sceneNamed("PointLight");
    scene.environment = {};
    for (scene::Material& m : scene.materials) m.emission = glm::vec3(0);
    ASSERT_FALSE(scene.lights.empty());
    const auto point = scene.lights.front();
    scene.lights.clear();
    for (const glm::vec3 hue : {glm::vec3(9, 1, 1), glm::vec3(1, 7, 2), glm::vec3(1, 2, 8)}) {
        scene.lights.push_back(point);
        scene.lights.back().intensity = hue;
        scene.lights.back().position = point.position + 0.2f * (hue - glm::vec3(3));
    }
    const auto settings = [](Method method) {
        Settings s = resting(method);
        s.maxBounces = 1;
        return s;
    };

    // Moments of one frame's path.
    std::vector<glm::dvec3> f, square, ratio;
    std::vector<double> luminance;
    {
        Renderer renderer(device(), scene, settings(Method::Pt));
        constexpr int SAMPLES = 2000;
        for (int i = 0; i < SAMPLES; ++i) {
            renderer.renderFrame();
            const Pixels frame = renderer.readFrame().pixels;
            f.resize(frame.size());
            square.resize(frame.size());
            ratio.resize(frame.size());
            luminance.resize(frame.size());
            for (size_t p = 0; p < frame.size(); ++p) {
                const glm::dvec3 value(frame[p]);
                const double y = glm::dot(value, glm::dvec3(LUMINANCE));
                f[p] += value / double(SAMPLES);
                square[p] += value * value / double(SAMPLES);
                luminance[p] += y / SAMPLES;
                if (y > 0) ratio[p] += value * value / y / double(SAMPLES);
            }
        }
    }
    double sigma2 = 0, plateau = 0;
    for (size_t p = 0; p < f.size(); ++p) {
        const glm::dvec3 s = square[p] - f[p] * f[p], v = luminance[p] * ratio[p] - f[p] * f[p];
        sigma2 += (s.x + s.y + s.z) / double(3 * f.size());
        plateau += (v.x + v.y + v.z) / double(3 * f.size());
    }

    // Autocovariance at n = 2, 4, ..., FRAMES; runs have seeds of their own.
    const auto autocovariance = [&](Method method) {
        Renderer renderer(device(), scene, settings(method));
        Settings own = settings(method);
        std::vector<std::vector<std::array<glm::dvec3, 3>>> sums; // by point and pixel: x, y, x y
        for (int run = 0; run < RUNS; ++run) {
            own.seed = uint64_t(run) + 77;
            renderer.apply(own);
            renderer.reset();
            Pixels previous;
            size_t point_ = 0;
            for (int n = 1; n <= FRAMES; ++n) {
                renderer.renderFrame();
                const bool isPoint = n >= 2 && (n & (n - 1)) == 0;
                const bool precedes = ((n + 1) & n) == 0;
                if (!isPoint && !precedes) continue;
                const Pixels now = renderer.readFrame().pixels;
                if (isPoint) {
                    if (sums.size() <= point_) sums.emplace_back(now.size());
                    for (size_t p = 0; p < now.size(); ++p) {
                        auto& [x, y, xy] = sums[point_][p];
                        x += glm::dvec3(previous[p]);
                        y += glm::dvec3(now[p]);
                        xy += glm::dvec3(previous[p]) * glm::dvec3(now[p]);
                    }
                    ++point_;
                }
                previous = now;
            }
        }
        std::vector<double> curve;
        for (const auto& pixels : sums) {
            double sum = 0;
            for (const auto& [x, y, xy] : pixels) {
                const glm::dvec3 c = (xy - x * y / double(RUNS)) / double(RUNS - 1);
                sum += (c.x + c.y + c.z) / double(3 * pixels.size());
            }
            curve.push_back(sum);
        }
        return curve;
    };
    const std::vector<double> rgb = autocovariance(Method::RgbRestir);
    const std::vector<double> single = autocovariance(Method::RestirPt);
    ASSERT_EQ(rgb.size(), 7u);
    for (size_t i = 0; i < rgb.size(); ++i) {
        const double n = std::pow(2.0, double(i + 1));
        EXPECT_NEAR(rgb[i], sigma2 / n, 0.06 * sigma2 / n) << "n = " << n;
        const double expected = sigma2 / n + (n - 2) / n * plateau;
        EXPECT_NEAR(single[i], expected, 0.05 * expected) << "n = " << n;
    }
    const double slope = std::log2(rgb.back() / rgb.front()) / double(rgb.size() - 1);
    EXPECT_NEAR(slope, -1.0, 0.03);
    EXPECT_NEAR(single.back(), plateau, 0.05 * plateau + sigma2 / FRAMES);
    RecordProperty("slope", std::to_string(slope));
    RecordProperty("plateau", std::to_string((single.back() - sigma2 / FRAMES) / plateau));
    std::printf("slope of rgb %.4f; luminance at n = %d over its plateau %.4f\n", slope, FRAMES,
                (single.back() - sigma2 / FRAMES) / ((FRAMES - 2.0) / FRAMES * plateau));
}
