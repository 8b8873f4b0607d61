// What ReSTIR owes exactly, not only in the mean: identities with the path tracer's own frames, and symmetries to the
// bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "passes/camera_path.h"
#include "passes/estimator.h"
#include "passes/renderer.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/test_scenes.h"

namespace
{

using passes::Color;
using passes::Method;
using passes::Renderer;
using passes::Settings;
using passes::Shift;
using Pixels = std::vector<glm::vec3>;

constexpr glm::vec3 LUMINANCE(0.2126f, 0.7152f, 0.0722f);

class RestirTest : public RendererFixture
{
  protected:
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
        return renderer.read(passes::LAST_FRAME).pixels;
    }

    // The path tracer's frames one by one.
    std::vector<Pixels> pathTraced(const scene::Scene& scene, int frames)
    {
        Renderer renderer(device(), scene, resting(Method::Pt));
        std::vector<Pixels> list;
        for (int i = 0; i < frames; ++i) {
            renderer.renderFrame();
            list.push_back(renderer.read(passes::LAST_FRAME).pixels);
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

// Exponential beyond M_c: S_n = S_(n-1) + (F_n - S_(n-1)) / (M_c + 1).
glm::dvec3 cappedMeanOver(const std::vector<Pixels>& frames, size_t maxConfidence, size_t pixel)
{
    glm::dvec3 mean(0);
    for (size_t i = 0; i < frames.size(); ++i)
        mean += (glm::dvec3(frames[i][pixel]) - mean) / double(std::min(i, maxConfidence) + 1);
    return mean;
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
            Renderer renderer(device(), scene, resting(Method::RgbRestir), {.featureSet = features});
            for (int i = 0; i < FRAMES; ++i) renderer.renderFrame();
            const Pixels picture = renderer.read(passes::LAST_FRAME).pixels;
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
// glass vertices.
TEST_F(RestirTest, HybridShiftsHomeAreIdentities)
{
    constexpr int FRAMES = 8;
    for (const char* name : {"Glossy", "FrostedGlass"}) {
        const scene::Scene scene = sceneNamed(name);
        const std::vector<Pixels> traced = pathTraced(scene, FRAMES);
        Settings settings = resting(Method::RgbRestir);
        settings.shift = Shift::Hybrid;
        Renderer renderer(device(), scene, settings, {.featureSet = scene::FeatureSet::Everything});
        for (int i = 0; i < FRAMES; ++i) renderer.renderFrame();
        const Pixels picture = renderer.read(passes::LAST_FRAME).pixels;
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
    const Pixels picture = renderer.read(passes::LAST_FRAME).pixels;
    size_t otherChannels = 0;
    for (size_t p = 0; p < picture.size(); ++p) {
        const glm::dvec3 mean = meanOver(traced, FRAMES, p);
        const double expected = glm::dot(mean, glm::dvec3(LUMINANCE));
        EXPECT_NEAR(glm::dot(glm::dvec3(picture[p]), glm::dvec3(LUMINANCE)), expected, 1e-4 * expected) << p;
        otherChannels += std::abs(picture[p].r - mean.r) > 0.01 * mean.r;
    }
    EXPECT_GT(otherChannels, picture.size() / 10); // else there was nothing to prove
}

// With the color estimate beside it each channel of luminance's picture is that mean, too.
TEST_F(RestirTest, VariateIsTheRunningMeanOfThePathTracer)
{
    constexpr int FRAMES = 24, MAX_CONFIDENCE = 16;
    for (const char* name : {"Glossy", "SunnySky"}) {
        const scene::Scene scene = sceneNamed(name);
        const std::vector<Pixels> traced = pathTraced(scene, FRAMES);
        for (const Method method : {Method::RestirPt, Method::GroupedRestir}) {
            Settings settings = resting(method);
            settings.color = Color::Variate;
            settings.maxConfidence = MAX_CONFIDENCE;
            Renderer renderer(device(), scene, settings);
            for (int i = 0; i < FRAMES; ++i) renderer.renderFrame();
            const Pixels picture = renderer.read(passes::LAST_FRAME).pixels;
            for (size_t p = 0; p < picture.size(); ++p) {
                const glm::dvec3 expected = cappedMeanOver(traced, MAX_CONFIDENCE, p);
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture[p][c], expected[c], 2e-6 * expected[c]) << p;
            }
        }
    }
}

// Reading color otherwise changes what is shown, and no reservoir: frames leave the same state behind, to the bit. And
// since the weights of weighted color are those that the sums add up, it changes no pixel's luminance (grouped
// reservoirs: neither r + g nor b).
TEST_F(RestirTest, ReadingColorKeepsReservoirsAndWeightedColorTheirTargets)
{
    struct Case {
        Method method;
        bool temporal;
        uint32_t spatial;
    };
    const scene::Scene scene = sceneNamed("SunnySky");
    const passes::CameraAt cameraAt = passes::cameraOrbit(scene.cameras.at(0), 2);
    const auto pipelines = std::make_shared<passes::PipelinePool>(device()); // compiled once for all cases
    for (const Case& c : {Case{Method::RestirPt, true, 2}, Case{Method::RestirPt, true, 0},
                          Case{Method::RestirPt, false, 2}, Case{Method::GroupedRestir, true, 2}}) {
        Settings settings = resting(c.method);
        settings.shift = Shift::Hybrid;
        settings.temporal = c.temporal;
        settings.spatial = c.spatial;
        settings.spatialRadius = 4;
        Pixels pictures[3];
        std::vector<std::byte> histories[3], paths[3];
        for (const Color color : {Color::Chosen, Color::Weighted, Color::Variate}) {
            settings.color = color;
            Renderer renderer(device(), scene, settings, {.pipelines = pipelines});
            for (uint64_t frame = 0; frame < 4; ++frame) {
                renderer.setCamera(cameraAt(frame));
                renderer.renderFrame();
            }
            pictures[size_t(color)] = renderer.read(passes::LAST_FRAME).pixels;
            for (auto& [name, bytes] : renderer.save().buffers) {
                if (name == "History")
                    histories[size_t(color)] = std::move(bytes);
                else if (name == "HistoryPaths")
                    paths[size_t(color)] = std::move(bytes);
            }
            for (const auto& [stage, count] : renderer.stats().nonFinite) EXPECT_EQ(count, 0u) << stage;
        }
        ASSERT_FALSE(histories[0].empty() || paths[0].empty());
        for (size_t i = 1; i < 3; ++i) EXPECT_TRUE(histories[0] == histories[i] && paths[0] == paths[i]) << i;
        size_t otherColors = 0, estimatedColors = 0;
        for (size_t p = 0; p < pictures[0].size(); ++p) {
            const glm::dvec3 chosen(pictures[0][p]), weighted(pictures[1][p]);
            for (const glm::vec3& target : passes::estimatorOf(c.method).target) {
                const double expected = glm::dot(glm::dvec3(target), chosen);
                EXPECT_NEAR(glm::dot(glm::dvec3(target), weighted), expected, 1e-5 * expected) << p;
            }
            otherColors += std::abs(chosen.r - weighted.r) > 0.001 * chosen.r;
            estimatedColors += std::abs(pictures[2][p].r - weighted.r) > 0.001 * chosen.r;
        }
        EXPECT_GT(otherColors, pictures[0].size() / 10); // else nothing was proved
        EXPECT_EQ(estimatedColors > pictures[0].size() / 10, c.temporal || c.spatial > 0);
    }
}

// Without reuse the last merge is that of a new tree's paths: what the path tracer adds.
TEST_F(RestirTest, ColorOfAllPathsWithoutReuseIsThePathTracer)
{
    const scene::Scene scene = sceneNamed("Glossy");
    const std::vector<Pixels> traced = pathTraced(scene, 2);
    for (const auto& [method, color] : {std::pair(Method::RestirPt, Color::Weighted),
                                        {Method::RestirPt, Color::Variate},
                                        {Method::GroupedRestir, Color::Weighted},
                                        {Method::GroupedRestir, Color::Variate}}) {
        Settings settings = resting(method);
        settings.temporal = false;
        settings.color = color;
        Renderer renderer(device(), scene, settings);
        renderer.renderFrame();
        renderer.renderFrame();
        const Pixels picture = renderer.read(passes::LAST_FRAME).pixels;
        for (size_t p = 0; p < picture.size(); ++p)
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture[p][c], traced[1][p][c], 4e-6 * traced[1][p][c]) << p;
    }
}

// At rest, frame M shows the new sample with 1 / M and what chosen color showed before with the rest. (Less what is
// seen directly, which is in all of them.)
TEST_F(RestirTest, WeightedColorAtRestIsTheMeanOfTheNewSampleAndTheOldPicture)
{
    constexpr int FRAMES = 7;
    const scene::Scene scene = sceneNamed("SunnySky");
    const auto lastOf = [&](Color color, bool temporal, int frames) {
        Settings settings = resting(Method::RestirPt);
        settings.color = color;
        settings.temporal = temporal;
        Renderer renderer(device(), scene, settings);
        for (int i = 0; i < frames; ++i) renderer.renderFrame();
        return renderer.read(passes::LAST_FRAME).pixels;
    };
    const Pixels before = lastOf(Color::Chosen, true, FRAMES - 1), single = lastOf(Color::Chosen, false, FRAMES),
                 weighted = lastOf(Color::Weighted, true, FRAMES);
    for (size_t p = 0; p < weighted.size(); ++p)
        for (int c = 0; c < 3; ++c) {
            const double expected = single[p][c] / double(FRAMES) + before[p][c] * (1 - 1.0 / FRAMES);
            EXPECT_NEAR(weighted[p][c], expected, 2e-6 * expected) << p;
        }
}

// Beyond M_c the mean becomes an exponential one.
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
    const Pixels picture = renderer.read(passes::LAST_FRAME).pixels;
    for (size_t p = 0; p < picture.size(); ++p) {
        const glm::dvec3 expected = cappedMeanOver(traced, MAX_CONFIDENCE, p);
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
        const Pixels picture = renderer.read(passes::LAST_FRAME).pixels;
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
