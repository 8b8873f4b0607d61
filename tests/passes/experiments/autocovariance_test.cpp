// The law of temporal reuse, as `correlate` measures it: chains against their closed form, one run for all caps.

#include "passes/experiments/autocovariance.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "tests/support/gpu_fixture.h"
#include "tests/support/test_scenes.h"

namespace
{

using passes::Color;
using passes::Method;
using passes::Renderer;
using passes::Settings;

class Autocovariance : public RendererFixture
{
  protected:
    // Point lights of three hues, and surfaces that glow: much color noise, light tails, and emission seen directly.
    static scene::Scene hues()
    {
        for (const support::TestScene& test : support::testScenes()) {
            if (std::string(test.name) != "PointLight") continue;
            scene::Scene scene = test.make();
            scene.environment = {};
            for (scene::Material& m : scene.materials) m.emission = glm::vec3(0.01f, 0.02f, 0.03f);
            const auto point = scene.lights.at(0);
            scene.lights.clear();
            for (const glm::vec3 hue : {glm::vec3(9, 1, 1), glm::vec3(1, 7, 2), glm::vec3(1, 2, 8)}) {
                scene.lights.push_back(point);
                scene.lights.back().intensity = hue;
                scene.lights.back().position = point.position + 0.2f * (hue - glm::vec3(3));
            }
            return scene;
        }
        throw std::invalid_argument("PointLight");
    }

    static Settings settings(Method method)
    {
        Settings s;
        s.width = 16;
        s.height = 12;
        s.maxBounces = 2;
        s.method = method;
        s.shift = passes::Shift::Replay;
        s.spatial = 0;
        s.maxConfidence = 1u << 20;
        s.average = false;
        return s;
    }

    Renderer renderer(const scene::Scene& scene, const Settings& s, uint32_t runs)
    {
        return {device(), scene, s, {}, runs};
    }

    image::Image emissionOf(const scene::Scene& scene)
    {
        Settings s = settings(Method::Pt);
        s.maxBounces = 0;
        Renderer dark = renderer(scene, s, 1);
        dark.renderFrame();
        return dark.read(passes::LAST_FRAME);
    }
};

std::vector<passes::ChainPoint> chainOf(Renderer& renderer, uint32_t lastFrame, const passes::CameraAt& cameraAt = {})
{
    passes::Chain chain(renderer, cameraAt);
    while (chain.frame() < lastFrame) chain.step();
    return chain.points();
}

passes::FrameLaw lawOf(Renderer& renderer, uint32_t frames, const image::Image& emission)
{
    passes::LawMeter meter(renderer, emission);
    while (meter.frames() < frames) meter.step();
    return meter.law();
}

double standardError(const statistics::Estimate& estimate)
{
    return std::sqrt(estimate.varianceOfMean);
}

} // namespace

// Trees of several paths, light seen directly, all three estimators, both ways of reading color: sigma^2 / M for RGB, V
// / M and a part of P for the others, within what both sides' jackknife says. RGB falls with slope -1; the others level
// off at P.
TEST_F(Autocovariance, FollowsTheClosedForm)
{
    constexpr uint32_t RUNS = 64, FRAMES = 128, LAW_FRAMES = 160;
    const scene::Scene scene = hues();
    const image::Image emission = emissionOf(scene);
    Settings plainSettings = settings(Method::Pt);
    plainSettings.seed = 99; // independent of the chains
    Renderer traced = renderer(scene, plainSettings, RUNS);
    const passes::FrameLaw plain = lawOf(traced, LAW_FRAMES, emission);
    for (const auto& [method, color] : {std::pair(Method::RgbRestir, Color::Chosen),
                                        {Method::RestirPt, Color::Chosen},
                                        {Method::RestirPt, Color::Weighted},
                                        {Method::RestirPt, Color::Variate},
                                        {Method::GroupedRestir, Color::Chosen},
                                        {Method::GroupedRestir, Color::Weighted}}) {
        Settings s = settings(method);
        s.color = color;
        Renderer own = renderer(scene, s, RUNS);
        const std::vector<passes::ChainPoint> points = chainOf(own, FRAMES);
        s.seed = plainSettings.seed;
        own.apply(passes::lawSettings(s));
        const passes::FrameLaw law = lawOf(own, LAW_FRAMES, emission);
        ASSERT_EQ(points.size(), 7u);
        for (const passes::ChainPoint& point : points) {
            const statistics::Estimate measured = statistics::combine(std::span(&point.autocovariance, 1));
            const bool asTraced = color == Color::Variate || (color == Color::Weighted && point.frame == 2);
            const passes::FrameLaw& single = asTraced ? plain : law;
            const statistics::BatchValue prediction = passes::predictedAutocovariance(single, color, point.frame);
            const statistics::Estimate predicted = statistics::combine(std::span(&prediction, 1));
            const statistics::Difference difference = statistics::compare(measured, predicted);
            EXPECT_GT(difference.p, 1e-4)
                << "method " << int(method) << ", color " << int(color) << ", M = " << point.frame << ": "
                << measured.mean << " against " << predicted.mean;
            // Else the agreement says little.
            EXPECT_LT(difference.standardError, 0.06 * predicted.mean) << int(method) << " " << point.frame;
        }
        // Frames further apart, and the mean of all.
        const auto expectPredicted = [&](const statistics::BatchValue& value, const statistics::BatchValue& law_,
                                         const std::string& what) {
            const statistics::Estimate measured = statistics::combine(std::span(&value, 1));
            const statistics::Estimate predicted = statistics::combine(std::span(&law_, 1));
            const statistics::Difference difference = statistics::compare(measured, predicted);
            EXPECT_GT(difference.p, 1e-4) << what << ": " << measured.mean << " against " << predicted.mean;
            EXPECT_LT(difference.standardError, 0.06 * predicted.mean) << what;
        };
        SCOPED_TRACE("method " + std::to_string(int(method)) + ", color " + std::to_string(int(color)));
        const passes::FrameLaw& single = color == Color::Variate ? plain : law;
        ASSERT_EQ(points.back().lags.size(), 6u);
        for (const passes::LagPoint& lag : points.back().lags)
            expectPredicted(lag.autocovariance, passes::predictedAutocovariance(single, color, FRAMES, lag.lag),
                            "lag " + std::to_string(lag.lag));
        ASSERT_TRUE(points.back().film);
        if (color != Color::Weighted)
            expectPredicted(*points.back().film, passes::predictedFilm(single, FRAMES), "film");
        const double last = points.back().autocovariance.value;
        if (method == Method::RgbRestir || color == Color::Variate) {
            if (method == Method::RgbRestir) {
                EXPECT_NEAR(law.plateau.value, 0, 1e-12 * law.variance.value);
            }
            const double slope = std::log2(last / points.front().autocovariance.value) / double(points.size() - 1);
            EXPECT_NEAR(slope, -1.0, 0.03);
        } else {
            const statistics::Estimate plateau = statistics::combine(std::span(&law.plateau, 1));
            EXPECT_GT(plateau.mean, 10 * standardError(plateau));
            EXPECT_NEAR(last - law.variance.value / FRAMES, plateau.mean, 0.05 * plateau.mean);
        }
        for (const auto& [stage, count] : own.stats().nonFinite) EXPECT_EQ(count, 0u) << stage;
    }
}

// Samples that history holds are exchanged for others: a frame is as noisy, one long before has nothing to do with it,
// and so the mean of all frames goes on converging. Where the picture knows no single sample nothing changes.
TEST_F(Autocovariance, MutationsThawFrozenSamples)
{
    constexpr uint32_t RUNS = 64, FRAMES = 128;
    const scene::Scene scene = hues();
    const auto last = [&](Method method, Color color, passes::Mutate mutate) {
        Settings s = settings(method);
        s.color = color;
        s.mutate = mutate;
        Renderer own = renderer(scene, s, RUNS);
        passes::ChainPoint point = chainOf(own, FRAMES).back();
        for (const auto& [stage, count] : own.stats().nonFinite) EXPECT_EQ(count, 0u) << stage;
        EXPECT_EQ(own.stats().mutations.at("accepted") > 0, mutate == passes::Mutate::Free);
        return point;
    };
    using enum passes::Mutate;
    const passes::ChainPoint frozen = last(Method::RestirPt, Color::Chosen, Off);
    const passes::ChainPoint thawed = last(Method::RestirPt, Color::Chosen, Free);
    EXPECT_NEAR(thawed.variance.value, frozen.variance.value, 0.1 * frozen.variance.value);
    EXPECT_LT(thawed.autocovariance.value, 0.9 * frozen.autocovariance.value);
    EXPECT_LT(thawed.lags.back().autocovariance.value, 0.3 * frozen.lags.back().autocovariance.value);
    EXPECT_LT(thawed.film->value, 0.5 * frozen.film->value);
    for (const auto& [method, color] :
         {std::pair(Method::RgbRestir, Color::Chosen), {Method::RestirPt, Color::Variate}}) {
        const passes::ChainPoint off = last(method, color, Off), free = last(method, color, Free);
        EXPECT_NEAR(free.autocovariance.value, off.autocovariance.value, 1e-5 * off.autocovariance.value);
        EXPECT_NEAR(free.film->value, off.film->value, 1e-5 * off.film->value);
    }
}

// "One run yields all points": a chain whose cap is M shows at frame M what the uncapped chain shows there.
TEST_F(Autocovariance, OneChainServesEveryCap)
{
    constexpr uint32_t RUNS = 3, FRAMES = 16;
    const scene::Scene scene = hues();
    Settings s = settings(Method::RestirPt);
    Renderer own = renderer(scene, s, RUNS);
    const std::vector<passes::ChainPoint> points = chainOf(own, FRAMES);
    for (const passes::ChainPoint& point : points) {
        s.maxConfidence = point.frame;
        own.apply(s);
        EXPECT_EQ(chainOf(own, point.frame).back(), point) << "M_c = " << point.frame;
    }
    s.maxConfidence = FRAMES / 4; // where it binds, it shows
    own.apply(s);
    EXPECT_NE(chainOf(own, FRAMES).back(), points.back());
}

// A camera that moves by exactly nothing pairs every pixel that sees something with itself: the same figure, over
// those.
TEST_F(Autocovariance, AlongReprojectedPixelsIsTheSameFigureAtRest)
{
    const scene::Scene scene = hues();
    Settings s = settings(Method::RestirPt);
    Renderer own = renderer(scene, s, 8);
    const std::vector<passes::ChainPoint> rest = chainOf(own, 8);
    const std::vector<passes::ChainPoint> pairs = chainOf(own, 8, [&](uint64_t) { return scene.cameras[0]; });
    ASSERT_EQ(pairs.size(), rest.size());
    for (size_t i = 0; i < rest.size(); ++i) {
        EXPECT_LE(pairs[i].pixels, rest[i].pixels);
        // The others see the sky alone, without noise.
        EXPECT_NEAR(pairs[i].autocovariance.value * double(pairs[i].pixels),
                    rest[i].autocovariance.value * double(rest[i].pixels), 1e-9);
    }
    // One that turns fast finds less history, and frames depend less on each other.
    const std::vector<passes::ChainPoint> moving = chainOf(own, 8, passes::cameraOrbit(scene.cameras[0], 20));
    EXPECT_GT(moving.back().pixels, pairs.back().pixels / 4);
    const auto correlation = [](const passes::ChainPoint& p) { return p.autocovariance.value / p.variance.value; };
    EXPECT_GT(correlation(moving.back()), 0.1);
    EXPECT_LT(correlation(moving.back()), 0.9 * correlation(pairs.back()));
}
