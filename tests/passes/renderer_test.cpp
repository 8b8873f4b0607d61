// Covers passes/scene_on_device.cpp, passes/stage.cpp.

#include "passes/renderer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "engine/base/error.h"
#include "engine/base/statistics.h"
#include "engine/scene/motion.h"
#include "engine/scene/shapes.h"
#include "passes/inspector.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/moving_worlds.h"
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
        Renderer all(device(), scene_, settings, {}, scene::FeatureSet::Everything);
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
        Renderer many(device(), scene_, settings, {}, scene::FeatureSet::Needed, 3);
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
    Renderer renderer(device(), scene_, settings, {}, scene::FeatureSet::Needed, RUNS);
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

// ------------------------------------------------------------------------------------------------- a scene that moves

namespace
{

class MovingRenderer : public RendererFixture
{
  protected:
    static scene::Scene worldAt(const std::string& name, uint32_t frame)
    {
        for (const support::MovingWorld& world : support::movingWorlds())
            if (world.name == name) return world.at(frame);
        throw std::invalid_argument(name);
    }
    static scene::Scene ball(uint32_t frame) { return worldAt("BallRolls", frame); }
    static passes::Settings settings(passes::Method method)
    {
        passes::Settings s;
        s.method = method;
        s.width = s.height = 32;
        s.maxBounces = 3;
        s.spatial = 2;
        s.spatialRadius = 4;
        s.shift = passes::Shift::Hybrid;
        return s;
    }
    Renderer renderer(const scene::Scene& scene, const passes::Settings& settings, bool moves)
    {
        if (!pipelines_) pipelines_ = std::make_shared<passes::PipelinePool>(device());
        return {device(), scene, settings, {}, scene::FeatureSet::Needed, 1, pipelines_, moves};
    }
    Renderer moving(const scene::Scene& scene, const passes::Settings& settings)
    {
        return renderer(scene, settings, true);
    }
    static Pixels lastFrame(Renderer& renderer) { return renderer.read(passes::LAST_FRAME).pixels; }
    static size_t different(const Pixels& a, const Pixels& b)
    {
        size_t count = 0;
        for (size_t p = 0; p < a.size(); ++p) count += !(glm::distance(a[p], b[p]) <= 1e-4f * glm::length(b[p]));
        return count;
    }
    static void expectFinite(Renderer& renderer)
    {
        for (const auto& [stage, count] : renderer.stats().nonFinite) EXPECT_EQ(count, 0u) << stage;
    }
    static uint64_t primaryRays(Renderer& renderer) { return renderer.stats().rays.at("primary"); }

    static constexpr uint64_t PIXELS = uint64_t{32} * 32;

  private:
    std::shared_ptr<passes::PipelinePool> pipelines_; // shaders are compiled once a test
};

// Never moved it is the still scene, on lavapipe the path tracer's to the bit: the tree is another one, shifts know of
// areas, and compilers reorder.
TEST_F(MovingRenderer, ThatNeverMovesGivesThePictureOfTheStillOne)
{
    for (const passes::Method method : {passes::Method::Pt, passes::Method::RgbRestir}) {
        Renderer still = renderer(ball(0), settings(method), false), moves = moving(ball(0), settings(method));
        for (int frame = 0; frame < 4; ++frame) {
            still.renderFrame();
            moves.renderFrame();
            const size_t pixels = different(lastFrame(moves), lastFrame(still));
            EXPECT_LE(pixels, 2u) << int(method) << ' ' << frame;
        }
        EXPECT_EQ(primaryRays(moves), primaryRays(still));
        expectFinite(moves);
    }
}

// In both worlds' places, pose after pose, the path tracer's frame is what a still renderer of that pose gives.
TEST_F(MovingRenderer, ShowsEachPoseAsAStillRendererDoes)
{
    for (const char* name : {"BallMirrored", "BallVanishes", "LampChanges", "LightsWander", "BumpsMove"}) {
        Renderer moves = moving(worldAt(name, 0), settings(passes::Method::Pt));
        for (uint32_t frame = 0; frame < 4; ++frame) {
            moves.setScene(worldAt(name, frame), frame);
            moves.renderFrame();
            Renderer still(device(), worldAt(name, frame), settings(passes::Method::Pt), {}, scene::FeatureSet::Needed,
                           1, moves.pipelines());
            for (uint32_t i = 0; i <= frame; ++i) still.renderFrame(); // of equal random numbers
            const size_t pixels = different(lastFrame(moves), lastFrame(still));
            EXPECT_LE(pixels, 4u) << name << ' ' << frame;
        }
        expectFinite(moves);
    }
}

TEST_F(MovingRenderer, ShowsTheLastPoseThatItWasGiven)
{
    const passes::Settings restir = settings(passes::Method::RgbRestir);
    Renderer direct = moving(ball(0), restir), detour = moving(ball(0), restir);
    for (uint32_t frame = 0; frame < 4; ++frame) {
        detour.setScene(ball(frame + 7), frame + 0.5);
        for (Renderer* renderer : {&detour, &direct}) {
            renderer->setScene(ball(frame), frame);
            EXPECT_EQ(renderer->sceneSeconds(), frame);
            renderer->renderFrame();
        }
        EXPECT_EQ(lastFrame(detour), lastFrame(direct)) << frame;
    }
    EXPECT_EQ(primaryRays(direct), 4 * PIXELS);
    expectFinite(direct);
}

// While it stays where it is, frames are those of a scene that rests.
TEST_F(MovingRenderer, DoesNothingWhereItIsThereAlready)
{
    const passes::Settings restir = settings(passes::Method::RgbRestir);
    Renderer renderer = moving(ball(0), restir), once = moving(ball(0), restir);
    once.setScene(ball(2), 2);
    for (int frame = 0; frame < 4; ++frame) {
        renderer.setScene(frame == 0 ? ball(2) : ball(9), 2);
        renderer.renderFrame();
        once.renderFrame();
        EXPECT_EQ(lastFrame(renderer), lastFrame(once)) << frame;
    }
    EXPECT_EQ(primaryRays(renderer), PIXELS);
    renderer.setScene(ball(3), 3);
    renderer.renderFrame();
    renderer.renderFrame();
    EXPECT_EQ(primaryRays(renderer), 2 * PIXELS);
}

// Between reset() and the first frame there is no frame before: whatever was shown is forgotten.
TEST_F(MovingRenderer, StartsAgainAfterAReset)
{
    Renderer renderer = moving(ball(0), settings(passes::Method::RgbRestir));
    const auto play = [&] {
        Pixels last;
        for (uint32_t frame = 0; frame < 3; ++frame) {
            renderer.setScene(ball(frame), frame);
            renderer.renderFrame();
        }
        return lastFrame(renderer);
    };
    const Pixels first = play();
    renderer.reset();
    EXPECT_EQ(play(), first);
    renderer.setScene(ball(8), 8);
    renderer.reset(); // the pose that no frame has shown is the first one's now
    renderer.setScene(ball(9), 9);
    renderer.apply(renderer.settings());
    EXPECT_EQ(play(), first);
    expectFinite(renderer);
}

TEST_F(MovingRenderer, ASiblingHasItsOwnPoseAndSharesTextures)
{
    scene::Scene textured = ball(0);
    textured.uv0.resize(textured.positions.size());
    textured.images.push_back(
        {.width = 1024, .height = 1024, .rgba = std::vector<uint8_t>(size_t{4} * 1024 * 1024, 200)});
    textured.materials[1].baseColorTexture.image = uint32_t(textured.images.size() - 1);
    const auto sceneAt = [&](uint32_t frame) {
        scene::Scene scene = textured;
        scene.positions = ball(frame).positions;
        scene.normals = ball(frame).normals;
        return scene;
    };
    const passes::Settings restir = settings(passes::Method::RgbRestir);
    Renderer alone = moving(textured, restir), first = moving(textured, restir);
    const uint64_t before = device().allocatedBytes();
    Renderer sibling(first, restir);
    EXPECT_LT(device().allocatedBytes() - before, uint64_t{1024} * 1024 * 4);
    EXPECT_EQ(sibling.scene().fingerprint(), first.scene().fingerprint());
    for (uint32_t frame = 0; frame < 3; ++frame) {
        first.setScene(sceneAt(9 - frame), 9 - frame);
        sibling.setScene(sceneAt(frame), frame);
        alone.setScene(sceneAt(frame), frame);
        for (Renderer* renderer : {&first, &sibling, &alone}) renderer->renderFrame();
        EXPECT_EQ(lastFrame(sibling), lastFrame(alone)) << frame;
        EXPECT_NE(lastFrame(first), lastFrame(sibling)) << frame;
    }
    expectFinite(sibling);
}

TEST_F(MovingRenderer, GoesOnInTheMiddleOfMotionToTheSameBits)
{
    // Rests in frames 3 and 4: what the last one hit is known, also to whoever goes on from it.
    const auto seconds = [](uint32_t frame) { return frame < 3 ? frame : frame < 5 ? 2u : frame - 2; };
    const auto render = [&](Renderer& renderer, uint32_t until) {
        while (renderer.frameCount() < until) {
            const uint32_t at = seconds(uint32_t(renderer.frameCount()));
            renderer.setScene(ball(at), at);
            renderer.renderFrame();
        }
    };
    for (const passes::Method method : {passes::Method::Pt, passes::Method::RgbRestir})
        for (const uint32_t frames : {2u, 4u, 5u}) {
            Renderer whole = moving(ball(0), settings(method));
            render(whole, frames);
            const passes::RendererState state = whole.save();
            render(whole, 7);
            Renderer second = moving(ball(0), settings(method));
            EXPECT_EQ(second.scene().fingerprint(), whole.scene().fingerprint());
            render(second, 3); // forgotten
            second.restore(state);
            EXPECT_FALSE(second.sceneSeconds());
            const uint32_t last = seconds(frames - 1);
            second.setScene(ball(last), last);
            render(second, 7);
            EXPECT_EQ(lastFrame(second), lastFrame(whole)) << int(method) << ' ' << frames;
            EXPECT_EQ(second.read(passes::MEAN).pixels, whole.read(passes::MEAN).pixels);
            std::map<std::string, uint64_t> rays = second.stats().rays;
            // What pixels see is kept for reuse alone: the path tracer looks again.
            if (method == passes::Method::Pt && frames == 4) rays["primary"] -= PIXELS;
            EXPECT_EQ(rays, whole.stats().rays);
        }
}

// A pose that is refused is none: the next frame shows the one before. Pairs of triangles torn apart, in a chain of
// smaller and smaller ones whose tree is too deep.
TEST_F(MovingRenderer, ThatIsRefusedAPoseStaysInTheOneBefore)
{
    const auto quads = [](auto&& place) {
        scene::Scene scene;
        scene::addMaterial(scene, scene::diffuse("gray", {0.5f, 0.5f, 0.5f}));
        for (uint32_t i = 0; i < 400; ++i) {
            const auto [corner, size] = place(i);
            scene::addQuad(scene, 0, corner, {size, 0, 0}, {0, size, 0});
        }
        scene.lights.push_back({.intensity = glm::vec3(100), .position = {10, 10, 20}});
        scene.cameras.push_back(scene::lookAt("camera", {10, 10, 25}, {10, 10, 0}, 50));
        scene.motion = std::make_shared<scene::Motion>();
        return scene;
    };
    using Place = std::pair<glm::vec3, float>;
    const auto grid = [&](float z) {
        return quads([z](uint32_t i) { return Place{{float(i % 20), float(i / 20), z}, 0.5f}; });
    };
    scene::Scene chain = quads([](uint32_t i) {
        const float s = std::pow(0.93f, float(i));
        return Place{{s, 0, s}, s};
    });
    for (size_t t = 1; t < chain.triangles.size(); t += 2)
        std::swap(chain.triangles[t].vertices[1], chain.triangles[t].vertices[2]);
    const passes::Settings restir = settings(passes::Method::RestirPt);
    Renderer renderer = moving(grid(0), restir), calm = moving(grid(0), restir);
    for (uint32_t frame = 0; frame < 3; ++frame) {
        for (Renderer* each : {&renderer, &calm}) each->setScene(grid(0.1f * float(frame)), frame);
        EXPECT_THROW(renderer.setScene(chain, 100 + frame), Error);
        EXPECT_EQ(renderer.sceneSeconds(), frame);
        for (int i = 0; i < 2; ++i) {
            for (Renderer* each : {&renderer, &calm}) each->renderFrame();
            EXPECT_EQ(lastFrame(renderer), lastFrame(calm)) << frame;
            EXPECT_THROW(renderer.setScene(chain, 200 + frame), Error);
        }
    }
    EXPECT_EQ(primaryRays(renderer), primaryRays(calm));
}

// A wall that slides to the right by three pixels was three pixels further left, and one that went to the left, right.
TEST_F(MovingRenderer, KnowsWherePointsOfWhatMovesWereSeenBefore)
{
    const passes::Settings restir = settings(passes::Method::RestirPt);
    const double pixel = 2 * std::tan(0.5 * 40 * 3.14159265358979 / 180) * 3 / restir.height; // at the wall
    const auto wallAt = [&](double pixels) {
        scene::Scene scene;
        scene::addQuad(scene, scene::addMaterial(scene, scene::diffuse("wall", {0.5f, 0.5f, 0.5f})),
                       {-4 + float(pixels * pixel), -4, 0}, {8, 0, 0}, {0, 8, 0});
        scene.lights.push_back({.intensity = glm::vec3(1), .position = {0, 0, 3}});
        scene.cameras.push_back(scene::lookAt("camera", {0, 0, 3}, {0, 0, 0}, 40));
        scene.motion = std::make_shared<scene::Motion>();
        return scene;
    };
    Renderer renderer = moving(wallAt(0), restir);
    const auto expectMoved = [&](int by) {
        size_t found = 0, wrong = 0;
        const std::vector<uint32_t> list = renderer.readPreviousPixels();
        for (uint32_t p = 0; p < list.size(); ++p) {
            if (list[p] == shared::NO_NEIGHBOR) continue;
            ++found;
            wrong +=
                list[p] % restir.width + uint32_t(by) != p % restir.width || list[p] / restir.width != p / restir.width;
        }
        EXPECT_EQ(wrong, 0u) << by;
        EXPECT_EQ(found, size_t(int(restir.width) - std::abs(by)) * restir.height) << by;
    };
    double place = 0;
    const auto move = [&](int by) {
        place += by;
        renderer.setScene(wallAt(place), place);
        renderer.renderFrame();
    };
    renderer.renderFrame();
    move(3);
    expectMoved(3);
    move(-5);
    expectMoved(-5);
    renderer.renderFrame();
    expectMoved(0);
    move(2);
    expectMoved(2);
}

// What it shows is the last frame, also where the next pose is there already.
TEST_F(MovingRenderer, IsInspectedAsTheLastFrameShowedIt)
{
    Renderer renderer = moving(ball(0), settings(passes::Method::RgbRestir));
    passes::Inspector inspector(renderer);
    for (uint32_t frame = 0; frame < 4; ++frame) {
        renderer.setScene(ball(frame), frame);
        renderer.renderFrame();
    }
    const auto seen = [&] {
        std::vector<float> numbers;
        for (uint32_t pixel = 0; pixel < PIXELS; pixel += 5)
            for (const auto& path : inspector.paths(pixel))
                for (size_t i = 0; i < path.size(); ++i) {
                    const shared::PathPoint& point = path[i];
                    if (i == 0) {
                        EXPECT_NEAR((0.5 + 0.5 * point.x / point.depth) * 32, pixel % 32 + 0.5, 0.01);
                        EXPECT_NEAR((0.5 - 0.5 * point.y / point.depth) * 32, uint32_t(pixel / 32) + 0.5, 0.01);
                    }
                    numbers.insert(numbers.end(), {point.x, point.y, point.depth, float(point.kind)});
                }
        return numbers;
    };
    const std::vector<float> before = seen();
    const std::vector<passes::ShiftCounts> shifts = inspector.shifts();
    EXPECT_GT(before.size(), 1000u);
    renderer.setScene(ball(9), 9);
    EXPECT_EQ(seen(), before);
    EXPECT_EQ(inspector.shifts(), shifts);
}

// Two files of one picture that move in different ways are not one scene.
TEST_F(MovingRenderer, IsOfAnotherSceneWhereItMovesOtherwise)
{
    const auto fingerprint = [](auto&& change) {
        scene::Scene scene = ball(0);
        scene::Motion motion;
        motion.numbers = {{0, 1}, {0, 0, 0, 1, 2, 3}};
        motion.nodes.emplace_back();
        motion.animations.push_back({.channels = {{.width = 3, .times = 0, .values = 1}}});
        change(motion);
        scene.motion = std::make_shared<scene::Motion>(motion);
        return passes::SceneOnDevice(device(), scene, scene.cameras[0], scene::FeatureSet::Needed, {}, nullptr, true)
            .fingerprint();
    };
    const std::vector<uint64_t> all = {
        fingerprint([](scene::Motion&) {}),
        fingerprint([](scene::Motion& m) { m.numbers[1][5] = 4; }),
        fingerprint([](scene::Motion& m) { m.numbers[0][1] = 2; }),
        fingerprint([](scene::Motion& m) { m.animations[0].channels[0].property = scene::Property::Scale; }),
        fingerprint([](scene::Motion& m) { m.nodes[0].rest.translation.x = 1; }),
        fingerprint([](scene::Motion& m) { m.skins.push_back({.joints = {0}, .inverseBindings = {glm::dmat4(2)}}); }),
        fingerprint([](scene::Motion& m) { m.paints.push_back({.material = 1, .roughness = 0.5}); })};
    EXPECT_EQ(std::set(all.begin(), all.end()).size(), all.size());
    EXPECT_EQ(all[0], fingerprint([](scene::Motion&) {}));
}

} // namespace
