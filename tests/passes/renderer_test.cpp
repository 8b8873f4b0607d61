// Covers passes/scene_on_device.cpp, passes/stage.cpp.

#include "passes/renderer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "engine/base/statistics.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/test_scenes.h"

namespace
{

using passes::Renderer;
using Pixels = std::vector<glm::vec3>;

class RendererTest : public RendererFixture
{
  protected:
    static support::TestScene sceneNamed(const std::string& name)
    {
        for (const support::TestScene& test : support::testScenes())
            if (test.name == name) return test;
        throw std::invalid_argument(name);
    }
    Renderer make(const passes::Settings& settings) { return {device(), scene_, settings}; }
    static Pixels frames(Renderer& renderer, int count)
    {
        for (int i = 0; i < count; ++i) renderer.renderFrame();
        return renderer.read(passes::MEAN).pixels;
    }

    const support::TestScene test_ = sceneNamed("Glossy");
    const scene::Scene scene_ = test_.make();
    const passes::Settings settings_ = test_.settings();
};

TEST_F(RendererTest, GivesEqualPixelsForEqualSettings)
{
    Renderer first = make(settings_), second = make(settings_);
    EXPECT_EQ(frames(first, 3), frames(second, 3));
}

TEST_F(RendererTest, StartsAgainAfterAReset)
{
    Renderer renderer = make(settings_);
    const Pixels before = frames(renderer, 3);
    renderer.reset();
    EXPECT_EQ(renderer.frameCount(), 0u);
    EXPECT_EQ(frames(renderer, 3), before);
}

// So that a chain of frames can begin anywhere, and is the same whatever was rendered before.
TEST_F(RendererTest, ForgetsHistoryAndGoesOnWithAnyFrame)
{
    passes::Settings settings = settings_;
    settings.method = passes::Method::RestirPt;
    settings.average = false;
    Renderer one = make(settings), other(one, settings);
    const auto chain = [](Renderer& renderer) { // frames 5 and 6
        renderer.setFrame(5);
        renderer.forgetHistory();
        frames(renderer, 2);
        return renderer.read(passes::LAST_FRAME).pixels;
    };
    const Pixels first = chain(one);
    frames(other, 3);
    EXPECT_EQ(chain(other), first);
    EXPECT_EQ(other.frameCount(), 5u);
    other.setFrame(5);
    frames(other, 2);
    EXPECT_NE(other.read(passes::LAST_FRAME).pixels, first); // with history
    other.reset();
    one.reset();
    one.setFrame(0);
    EXPECT_EQ(frames(other, 1), frames(one, 1));
}

TEST_F(RendererTest, GivesOtherPixelsForOtherSeedsAndFrames)
{
    passes::Settings other = settings_;
    other.seed = 1;
    Renderer first = make(settings_), second = make(other);
    const Pixels pixels = frames(first, 1);
    EXPECT_NE(pixels, frames(second, 1));
    first.renderFrame();
    EXPECT_NE(pixels, first.read(passes::LAST_FRAME).pixels);
}

TEST_F(RendererTest, MeansAreOfAllFrames)
{
    Renderer renderer = make(settings_);
    std::vector<glm::dvec3> sum(size_t{settings_.width} * settings_.height, glm::dvec3(0));
    for (int i = 0; i < 5; ++i) {
        renderer.renderFrame();
        const Pixels frame = renderer.read(passes::LAST_FRAME).pixels;
        for (size_t p = 0; p < sum.size(); ++p) sum[p] += glm::dvec3(frame[p]) / 5.0;
    }
    const Pixels mean = renderer.read(passes::MEAN).pixels;
    for (size_t p = 0; p < sum.size(); ++p) ASSERT_LT(glm::distance(sum[p], glm::dvec3(mean[p])), 1e-6) << p;
    EXPECT_EQ(renderer.read(passes::colorOf(renderer.settings())).pixels, mean);
    passes::Settings last = settings_;
    last.average = false;
    Renderer unaveraged = make(last);
    frames(unaveraged, 2);
    EXPECT_EQ(unaveraged.read(passes::colorOf(unaveraged.settings())).pixels,
              unaveraged.read(passes::LAST_FRAME).pixels);
}

TEST_F(RendererTest, CountsItsRaysAndFindsNothingThatIsNotFinite)
{
    Renderer renderer = make(settings_);
    frames(renderer, 2);
    const passes::RenderStats stats = renderer.stats();
    const uint64_t pixels = uint64_t{settings_.width} * settings_.height;
    EXPECT_EQ(stats.rays.at("primary"), pixels); // the second frame sees what the first saw
    EXPECT_GT(stats.rays.at("bounce"), 0u);
    EXPECT_LE(stats.rays.at("bounce"), 2 * pixels * settings_.maxBounces);
    EXPECT_GT(stats.rays.at("shadow"), 0u);
    for (const auto& [stage, count] : stats.nonFinite) EXPECT_EQ(count, 0u) << stage;
}

// Camera rays are left out while all are the same as in the frame before, and only then. The picture is the same but
// for what compilers reorder (tests/images/variants_test.cpp).
TEST_F(RendererTest, TracesCameraRaysOnlyWhereTheyDiffer)
{
    const uint64_t pixels = uint64_t{settings_.width} * settings_.height;
    scene::Camera away = scene_.cameras[0];
    away.position.x += 0.1;
    for (const passes::Method method : {passes::Method::Pt, passes::Method::RgbRestir}) {
        passes::Settings settings = settings_;
        settings.method = method;
        Renderer renderer = make(settings);
        Renderer all(device(), scene_, settings, {.featureSet = scene::FeatureSet::Everything});
        const auto expectSame = [&](uint64_t tracedFrames) {
            const Pixels left = frames(renderer, 1), right = frames(all, 1);
            size_t different = 0;
            for (size_t p = 0; p < left.size(); ++p)
                different += glm::distance(left[p], right[p]) > 1e-5f * glm::length(right[p]) ? 1 : 0;
            EXPECT_LE(different, 5u);
            EXPECT_EQ(renderer.stats().rays.at("primary"), tracedFrames * pixels);
        };
        expectSame(1);
        expectSame(1);
        expectSame(1);
        for (Renderer* each : {&renderer, &all}) each->setCamera(away);
        expectSame(2);
        expectSame(2);
        for (Renderer* each : {&renderer, &all}) each->setCamera(scene_.cameras[0]);
        expectSame(3);
        EXPECT_EQ(all.stats().rays.at("primary"), 6 * pixels);
    }
    passes::Settings jittered = settings_;
    jittered.pixelFilter = passes::PixelFilter::Box;
    Renderer renderer = make(jittered);
    frames(renderer, 2);
    EXPECT_EQ(renderer.stats().rays.at("primary"), 2 * pixels);
}

TEST_F(RendererTest, SeesThroughACameraThatIsSetLater)
{
    scene::Camera away = scene_.cameras[0];
    away.forward = -away.forward;
    away.right = -away.right;
    scene::Scene turned = scene_;
    turned.cameras[0] = away;
    Renderer expected(device(), turned, settings_), renderer = make(settings_);
    renderer.setCamera(away);
    EXPECT_EQ(frames(renderer, 1), frames(expected, 1));
}

// Scale is undone exactly: powers of two.
TEST_F(RendererTest, IsIndependentOfUnits)
{
    Renderer renderer = make(settings_);
    const Pixels pixels = frames(renderer, 2);
    for (const double exponent : {-40.0, 40.0}) {
        const auto factor = float(std::exp2(exponent));
        scene::Scene other = scene_;
        for (scene::Material& m : other.materials) m.emission *= factor;
        for (glm::vec3& radiance : other.environment.radiance) radiance *= factor;
        Renderer bright(device(), other, settings_);
        Pixels scaled = frames(bright, 2);
        for (glm::vec3& p : scaled) p /= factor;
        EXPECT_EQ(scaled, pixels) << "radiance times 2^" << exponent;
    }
    scene::Scene large = scene_;
    for (glm::vec3& p : large.positions) p *= 1024.0f;
    large.cameras[0].position *= 1024.0;
    Renderer far(device(), large, settings_);
    EXPECT_EQ(frames(far, 2), pixels);
}

TEST_F(RendererTest, ASiblingSharesTheSceneAndGivesItsOwnPixels)
{
    passes::Settings other = settings_;
    other.method = passes::Method::RgbRestir;
    other.seed = 3;
    Renderer alone = make(other), first = make(settings_);
    const Pixels expected = frames(alone, 2);
    Renderer sibling(first, other);
    EXPECT_EQ(frames(sibling, 1).size(), expected.size());
    frames(first, 1);
    EXPECT_EQ(frames(sibling, 1), expected);
    EXPECT_EQ(sibling.stats().sceneBytes, first.stats().sceneBytes);
}

// The list for those who compile ahead and the stages that really ran.
TEST_F(RendererTest, ListsTheStagesThatItsFramesConsistOf)
{
    Renderer renderer = make(settings_);
    std::vector<passes::Settings> all(4, settings_);
    all[1].method = passes::Method::RestirPt;
    all[2].method = passes::Method::RgbRestir;
    all[2].spatial = 0;
    all[3].method = passes::Method::RestirPt;
    all[3].temporal = false;
    for (const passes::Settings& settings : all) {
        renderer.apply(settings);
        frames(renderer, 2);
        std::set<std::string> listed, ran;
        for (const auto& [name, variant] : passes::stagesOf(renderer.scene(), {&settings, 1})) listed.insert(name);
        for (const auto& [name, milliseconds] : renderer.stats().stageMilliseconds) ran.insert(name);
        EXPECT_EQ(listed, ran);
    }
    const Pixels before = frames(renderer, 1);
    renderer.pipelines()->clear();
    renderer.recompile();
    EXPECT_EQ(frames(renderer, 3), before);
}

// Each knob, changed under a running renderer, keeps or forgets what its `Change` says; whoever starts over renders
// what a new renderer does (where that compiles nothing, for the test's time).
TEST_F(RendererTest, DoesWhatTheChangeOfEachKnobSays)
{
    using passes::Change;
    passes::Settings base = settings_;
    base.method = passes::Method::RgbRestir;
    const std::map<std::string, std::string> others = {
        {"method", "restir-pt"},
        {"shift", "replay"},
        {"max-confidence", "3"},
        {"temporal", "off"},
        {"spatial", "1"},
        {"spatial-radius", "4"},
        {"color", "chosen"},
        {"color-confidence", "3"},
        {"mutate", "free"},
        {"max-bounces", "1"},
        {"pixel-filter", "box"},
        {"size", fmt::format("{}x{}", 2 * base.width, 2 * base.height)}, // the camera stays, and with it the aspect
        {"camera", "0"},
        {"seed", "5"},
        {"frames", "7"},
        {"seconds", "7"},
        {"average", "off"}};
    const Renderer first = make(base);
    for (const passes::KnobText& knob : passes::describeSettings()) {
        if (knob.name.starts_with("environment")) continue; // the scene's, which a renderer keeps
        ASSERT_TRUE(others.contains(knob.name)) << knob.name << " needs another value above";
        passes::Settings next = base;
        passes::set(next, knob.name, others.at(knob.name));
        const Change change = passes::changeBetween(base, next);
        ASSERT_EQ(passes::differences(base, next).size(), 1u) << knob.name;
        Renderer renderer(first, base);
        frames(renderer, 2);
        renderer.apply(next);
        EXPECT_EQ(renderer.frameCount(), change >= Change::Reset ? 0u : 2u) << knob.name;
        if (knob.name != "size" && knob.name != "camera" && knob.name != "seed") continue;
        Renderer fresh(first, next);
        EXPECT_EQ(frames(renderer, 2), frames(fresh, 2)) << knob.name;
    }
}

} // namespace

// Side by side with others, a run is what it is alone: the camera, its history and its neighbors are its own.
TEST_F(RendererTest, TheFirstOfManyRunsIsTheLoneRun)
{
    passes::Settings settings = settings_;
    settings.width = 20; // neither side a multiple of a workgroup's
    settings.height = 13;
    settings.spatial = 1;
    settings.spatialRadius = 8;
    settings.shift = passes::Shift::Replay;
    settings.average = false;
    for (const passes::Method method : {passes::Method::Pt, passes::Method::RgbRestir}) {
        settings.method = method;
        Renderer lone = make(settings);
        Renderer many(device(), scene_, settings, {}, 3);
        for (int frame = 0; frame < 3; ++frame)
            for (Renderer* renderer : {&lone, &many}) {
                scene::Camera camera = scene_.cameras[0];
                camera.position += 0.02 * frame * camera.right;
                renderer->setCamera(camera);
                renderer->renderFrame();
            }
        const Pixels one = lone.read(passes::LAST_FRAME).pixels;
        const image::Image all = many.read(passes::LAST_FRAME);
        ASSERT_EQ(all.height, 3 * settings.height);
        EXPECT_EQ(one, Pixels(all.pixels.begin(), all.pixels.begin() + ptrdiff_t(one.size())));
        EXPECT_NE(one,
                  Pixels(all.pixels.begin() + ptrdiff_t(one.size()), all.pixels.begin() + 2 * ptrdiff_t(one.size())));
        EXPECT_EQ(many.readPreviousPixels(), lone.readPreviousPixels());
    }
}

// All runs have one expectation, and know nothing of each other.
TEST_F(RendererTest, RunsAreIndependentAndAlike)
{
    constexpr uint32_t RUNS = 6;
    constexpr int FRAMES = 200;
    passes::Settings settings = settings_;
    settings.width = settings.height = 12;
    Renderer renderer(device(), scene_, settings, {}, RUNS);
    const size_t pixels = size_t{settings.width} * settings.height;
    std::vector<statistics::Moments> values(RUNS * pixels);
    std::vector<Pixels> frames;
    for (int frame = 0; frame < FRAMES; ++frame) {
        renderer.renderFrame();
        frames.push_back(renderer.read(passes::LAST_FRAME).pixels);
        for (size_t i = 0; i < values.size(); ++i) values[i].add(frames.back()[i].g);
    }
    statistics::Moments correlation;
    for (size_t run = 0; run + 1 < RUNS; ++run)
        for (size_t p = 0; p < pixels; ++p) {
            const size_t a = run * pixels + p, b = a + pixels;
            double product = 0;
            for (const Pixels& frame : frames)
                product += (frame[a].g - values[a].mean()) * (frame[b].g - values[b].mean());
            const double scale = std::sqrt(values[a].variance() * values[b].variance());
            if (scale > 0) correlation.add(product / (FRAMES - 1) / scale);
        }
    ASSERT_GT(correlation.count(), pixels);
    EXPECT_LT(std::abs(correlation.mean()), 4 / std::sqrt(double(FRAMES) * double(correlation.count())));

    // Run against run, pixel by pixel: as many Welch tests, one family.
    std::vector<double> p;
    for (size_t run = 1; run < RUNS; ++run)
        for (size_t i = 0; i < pixels; ++i) {
            if (values[i].variance() == 0 && values[run * pixels + i].variance() == 0) {
                EXPECT_EQ(values[i].mean(), values[run * pixels + i].mean());
                continue;
            }
            p.push_back(compare(statistics::estimateOf(values[i]), statistics::estimateOf(values[run * pixels + i])).p);
        }
    EXPECT_GT(*std::ranges::min_element(p), statistics::sidakLevel(1e-3, p.size()));
}

TEST_F(RendererTest, NeighborsLieWithinAnEighteenthOfTheHeightUnlessToldOtherwise)
{
    passes::Settings settings = settings_;
    settings.method = passes::Method::RestirPt;
    settings.shift = passes::Shift::Replay;
    settings.width = 8;
    settings.height = 108;
    const auto at = [&](float radius) {
        settings.spatialRadius = radius;
        Renderer renderer = make(settings);
        return frames(renderer, 2);
    };
    const Pixels byHeight = at(0);
    EXPECT_EQ(byHeight, at(6));
    EXPECT_NE(byHeight, at(7));
}

TEST_F(RendererTest, KnowsWherePointsWereSeenBefore)
{
    Renderer renderer = make(settings_);
    renderer.renderFrame();
    renderer.renderFrame();
    size_t seen = 0;
    std::vector<uint32_t> list = renderer.readPreviousPixels();
    ASSERT_EQ(list.size(), size_t{settings_.width} * settings_.height);
    for (uint32_t p = 0; p < list.size(); ++p) {
        if (list[p] == shared::NO_NEIGHBOR) continue;
        EXPECT_EQ(list[p], p);
        ++seen;
    }
    EXPECT_GT(seen, list.size() / 4);

    // A camera turned right by about 3 pixels: what is seen now was further right before.
    scene::Camera camera = scene_.cameras[0];
    const double pixel = 2 * std::tan(camera.yfov / 2) / settings_.height;
    camera.forward = glm::normalize(camera.forward + 3 * pixel * camera.right);
    camera.right = glm::normalize(glm::cross(camera.forward, camera.up));
    renderer.setCamera(camera);
    renderer.renderFrame();
    list = renderer.readPreviousPixels();
    size_t moved = 0, found = 0;
    for (uint32_t p = 0; p < list.size(); ++p) {
        if (list[p] == shared::NO_NEIGHBOR) continue;
        ++found;
        const int dx = int(list[p] % settings_.width) - int(p % settings_.width);
        moved += dx >= 2 && dx <= 4;
    }
    EXPECT_GT(found, seen / 2);
    EXPECT_EQ(moved, found);
}
