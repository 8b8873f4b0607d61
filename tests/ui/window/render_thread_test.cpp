// What happens between the window and the device when things take long or break.
// Covers ui/window/compile_ahead.cpp, ui/window/contender.cpp.

#include "ui/window/render_thread.h"

#include "engine/gpu/vulkan.h"
#include "passes/sequence.h"
#include "tests/support/tiny_gltf.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

namespace
{

using namespace std::chrono_literals;

std::atomic<bool> lost = false;

gpu::Device open()
{
    const char* wanted = std::getenv("TRICHROME_TEST_DEVICE");
    gpu::Device device = gpu::Device::create({.adapter = wanted ? wanted : "llvmpipe"});
    device.state().queueSubmit = [](VkQueue queue, uint32_t count, const VkSubmitInfo* infos, VkFence fence) {
        return lost ? VK_ERROR_DEVICE_LOST : vkQueueSubmit(queue, count, infos, fence);
    };
    return device;
}

ui::Order small()
{
    ui::Order order{.scene = {.name = "cornell"}};
    order.settings.width = 32;
    order.settings.height = 18;
    order.settings.maxBounces = 1;
    return order;
}

// A glowing triangle before the camera, which is 9 m to the right after 2 s, in steps of its own: at 1 s, 2 m.
void fillMoving(TinyGltf& file)
{
    file.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
    file.json["nodes"].push_back({{"camera", 0}, {"translation", {0.4, 0.4, 2}}});
    file.json["scenes"][0]["nodes"].push_back(1);
    file.material()["emissiveFactor"] = {1, 1, 1};
    file.animate({{"node", 0}, {"path", "translation"}}, {0, 1, 2}, {0, 0, 0, 2, 0, 0, 9, 0, 0}, "VEC3");
    file.load(); // writes it
}

bool comes(const std::function<bool()>& condition) // within minutes, for busy machines
{
    for (int i = 0; i < 20000; ++i, std::this_thread::sleep_for(10ms))
        if (condition()) return true;
    return false;
}

} // namespace

TEST(RenderThread, ThePictureGoesOnWhileOtherSettingsAreCompiled)
{
    lost = false;
    ui::RenderThread thread(open, "", [] {});
    ui::Order order = small();
    thread.order(order);
    ASSERT_TRUE(comes([&] { return thread.shot(ui::A) != nullptr; }));
    order.settings.method = passes::Method::RgbRestir;
    thread.order(order);
    const uint64_t frames = thread.shot(ui::A)->frames;
    bool said = false, wentOn = false;
    ASSERT_TRUE(comes([&] {
        const ui::ShotPointer shot = thread.shot(ui::A);
        said = said || thread.activity().starts_with("Compiling");
        wentOn = wentOn || (shot->order.settings.method == passes::Method::Pt && shot->frames > frames);
        return shot->order.settings.method == passes::Method::RgbRestir;
    }));
    EXPECT_TRUE(said);
    EXPECT_TRUE(wentOn);
    EXPECT_EQ(thread.shot(ui::A)->stats.variant.at("RESERVOIR_COUNT"), "3");
}

TEST(RenderThread, ALostDeviceIsSaidThePictureStaysAndARestartOpensItAgain)
{
    lost = false;
    ui::RenderThread thread(open, "", [] {});
    ui::Order order = small(), back;
    thread.order(order);
    ASSERT_TRUE(comes([&] { return thread.shot(ui::A) != nullptr; }));
    lost = true;
    std::optional<std::string> failure;
    ASSERT_TRUE(comes([&] { return (failure = thread.takeFailure(back)).has_value(); }));
    EXPECT_NE(failure->find("lost"), std::string::npos) << *failure;
    EXPECT_EQ(back, order);
    const ui::ShotPointer last = thread.shot(ui::A);
    ASSERT_TRUE(last);
    lost = false;
    ++order.restarts;
    thread.order(order);
    EXPECT_TRUE(comes([&] { return thread.shot(ui::A) != last && thread.shot(ui::A)->frames > 0; }));
    EXPECT_GT(thread.shot(ui::A)->run, last->run);
}

TEST(RenderThread, APictureThatIsTooLargeChangesNothing)
{
    lost = false;
    ui::RenderThread thread(open, "", [] {});
    const ui::Order order = small();
    thread.order(order);
    ASSERT_TRUE(comes([&] { return thread.shot(ui::A) != nullptr; }));
    ui::Order large = order, back;
    large.settings.width = large.settings.height = 16384;
    thread.order(large);
    std::optional<std::string> failure;
    ASSERT_TRUE(comes([&] { return (failure = thread.takeFailure(back)).has_value(); }));
    EXPECT_NE(failure->find("--size"), std::string::npos) << *failure;
    EXPECT_EQ(back, order);
    const uint64_t frames = thread.shot(ui::A)->frames;
    EXPECT_TRUE(comes([&] { return thread.shot(ui::A)->frames > frames; }));
}

// The pose is a part of the scene: a film of the other pose begins.
TEST(RenderThread, AnotherTimeShowsAnotherPose)
{
    lost = false;
    TinyGltf file;
    fillMoving(file);
    ui::RenderThread thread(open, "", [] {});
    ui::Order order = small();
    order.scene.name = (file.folder / "tiny.gltf").string();
    const auto middle = [&](std::optional<double> time) {
        order.scene.time = time;
        thread.order(order);
        EXPECT_TRUE(comes([&] { return thread.shot(ui::A) && thread.shot(ui::A)->order == order; }));
        return thread.shot(ui::A)->picture.pixels.at(9 * 32 + 15);
    };
    EXPECT_EQ(middle(std::nullopt), glm::vec3(1));
    EXPECT_EQ(middle(2), glm::vec3(0));
    EXPECT_EQ(middle(0), glm::vec3(1));
}

// Both sides show the same time, a frame's step after the frame before, and `render` repeats it: frame f of a sequence.
TEST(RenderThread, PlayingStepsBothSidesThroughWhatASequenceShows)
{
    lost = false;
    TinyGltf file;
    fillMoving(file);
    ui::RenderThread thread(open, "", [] {});
    ui::Order order = small();
    order.scene = {.name = (file.folder / "tiny.gltf").string(), .time = 0.5};
    order.settings.shift = passes::Shift::Replay; // less to compile
    order.settings.spatial = 0;
    order.rival = order.settings;
    order.rival->method = passes::Method::RgbRestir;
    order.playing = order.paused = true; // a frame when it is asked for
    order.play = {.fps = 4, .speed = 2};
    constexpr uint64_t FRAMES = 6; // to 0.5, 1, 1.5, 0, 0.5 and 1 s
    for (uint64_t frame = 1; frame <= FRAMES; ++frame) {
        order.steps = frame - 1;
        thread.order(order);
        ASSERT_TRUE(comes([&] {
            return thread.shot(ui::A) && thread.shot(ui::B) && thread.shot(ui::A)->frames == frame &&
                   thread.shot(ui::B)->frames == frame;
        })) << frame
            << thread.activity();
        for (const ui::Side side : {ui::A, ui::B}) {
            EXPECT_EQ(thread.shot(side)->sceneSeconds, std::fmod(0.5 * double(frame), 2.0));
            EXPECT_TRUE(thread.shot(side)->single);
        }
    }

    gpu::Device device = open();
    for (const ui::Side side : {ui::A, ui::B}) {
        const passes::Settings settings = ui::settingsOf(order, side);
        scene::Scene scene = ui::openScene({.name = order.scene.name}, settings, [](const std::string&, double) {});
        passes::Renderer renderer(device, scene, settings, {.moves = true});
        const passes::Sequence sequence(scene, order.play.playback({0}, 0.5), 0);
        for (uint64_t frame = 0; frame < FRAMES; ++frame) {
            sequence.bring(renderer, int64_t(frame));
            renderer.renderFrame();
        }
        EXPECT_TRUE(renderer.read(passes::LAST_FRAME).pixels == thread.shot(side)->picture.pixels) << side;
    }

    // What starts over on one side does on both, there.
    order.rival->maxConfidence = 3;
    thread.order(order);
    ASSERT_TRUE(comes([&] { return thread.shot(ui::A)->frames == 1 && thread.shot(ui::B)->frames == 1; }));
    order.steps += 1;
    thread.order(order);
    ASSERT_TRUE(comes([&] { return thread.shot(ui::A)->frames == 2 && thread.shot(ui::B)->frames == 2; }));
    for (const ui::Side side : {ui::A, ui::B}) {
        EXPECT_EQ(thread.shot(side)->firstSeconds, 1.0);
        EXPECT_EQ(thread.shot(side)->sceneSeconds, 1.5);
    }

    order.playing = order.paused = false;
    order.scene.time = 1.5;
    thread.order(order);
    EXPECT_TRUE(comes([&] { return thread.shot(ui::A)->order == order && thread.shot(ui::A)->frames > 3; }));
    EXPECT_EQ(thread.shot(ui::A)->sceneSeconds, 1.5);
    EXPECT_FALSE(thread.shot(ui::A)->single);
}

// What is measured is of one time: at 1 s the triangle is out of the picture.
TEST(RenderThread, StudiesWaitUntilTheSceneRestsAndAreOfThatTime)
{
    lost = false;
    TinyGltf file;
    fillMoving(file);
    ui::RenderThread thread(open, "", [] {});
    ui::Order order = small();
    order.scene = {.name = (file.folder / "tiny.gltf").string(), .time = 0};
    order.settings.method = passes::Method::RestirPt;
    order.settings.shift = passes::Shift::Replay;
    order.settings.spatial = 0;
    order.settings.maxConfidence = 4;
    order.studies = {.reference = true, .correlation = true, .floor = true};
    order.playing = true;
    thread.order(order);
    ASSERT_TRUE(comes([&] { return thread.shot(ui::A) && thread.shot(ui::A)->frames > 20; }));
    EXPECT_FALSE(thread.findings()->reference);
    EXPECT_FALSE(thread.findings()->curves[ui::A]);
    order.playing = false;
    order.paused = true; // the pictures: studies have the time to themselves
    uint64_t before = 0; // the reference
    const auto reference = [&](double time) {
        order.scene.time = time;
        thread.order(order);
        EXPECT_TRUE(comes([&] { return thread.shot(ui::A)->order == order; }));
        EXPECT_TRUE(comes([&] {
            const auto findings = thread.findings();
            return findings->reference && findings->reference->converging != before && findings->curves[ui::A] &&
                   findings->floors[ui::A];
        }));
        before = thread.findings()->reference->converging;
        return thread.findings()->reference->picture.pixels.at(9 * 32 + 15);
    };
    EXPECT_EQ(reference(1), glm::vec3(0));
    EXPECT_EQ(reference(0), glm::vec3(1));
    order.settings.method = passes::Method::Pt; // less to compile
    order.studies = {.savings = 1};
    thread.order(order);
    EXPECT_TRUE(comes([&] { return thread.findings()->savings.has_value(); }));
}

TEST(RenderThread, AnAnimatedCameraIsFollowedUntilItIsTaken)
{
    lost = false;
    TinyGltf file;
    fillMoving(file);
    file.animate({{"node", 1}, {"path", "translation"}}, {0, 2}, {0.4f, 0.4f, 2, 0.4f, 0.4f, 4}, "VEC3");
    file.load();
    ui::RenderThread thread(open, "", [] {});
    ui::Order order = small();
    order.scene = {.name = (file.folder / "tiny.gltf").string(), .time = 0};
    const auto away = [&](double time) {
        order.scene.time = time;
        thread.order(order);
        EXPECT_TRUE(comes([&] { return thread.shot(ui::A) && thread.shot(ui::A)->order == order; }));
        return thread.shot(ui::A)->camera.position.z + thread.scene()->origin.z;
    };
    EXPECT_NEAR(away(0), 2, 1e-6);
    EXPECT_NEAR(away(1), 3, 1e-6);
    order.pose = ui::poseOf(thread.shot(ui::A)->camera, thread.scene()->origin);
    EXPECT_NEAR(away(2), 3, 1e-6);
    order.pose.reset();
    EXPECT_NEAR(away(2), 4, 1e-6);
}

// In a scene that rests; the second side joins on the way.
TEST(RenderThread, BothSidesFollowThePathFrameByFrameUntilTheCameraIsTaken)
{
    lost = false;
    ui::RenderThread thread(open, "", [] {});
    ui::Order order = small();
    order.path = ui::withKey(nullptr, 0, {.position = {0, 1, 5}, .target = {0, 1, 0}});
    order.path = ui::withKey(order.path, 5000, {.position = {0.5, 1.5, 4}, .target = {0, 1, 0}});
    thread.order(order);
    ASSERT_TRUE(comes([&] { return thread.shot(ui::A) != nullptr; }));
    const scene::Camera rest = thread.shot(ui::A)->camera;
    const passes::CameraAt at = passes::cameraPath(*order.path, rest, thread.scene()->origin);
    EXPECT_FALSE(rest == at(0));
    order.playing = true;
    order.frame = 7;
    thread.order(order);
    const auto frameOf = [](const ui::ShotPointer& shot) { return shot->firstFrame + shot->frames - 1; };
    const auto expectOnTheWay = [&](ui::Side side, uint64_t first) {
        ASSERT_TRUE(comes([&] {
            const ui::ShotPointer shot = thread.shot(side);
            return shot && shot->order.playing && shot->frames > 3 && shot->firstFrame >= first;
        }));
        const ui::ShotPointer shot = thread.shot(side);
        EXPECT_TRUE(shot->single);
        EXPECT_TRUE(shot->camera == at(frameOf(shot))) << frameOf(shot);
    };
    expectOnTheWay(ui::A, 7);
    EXPECT_EQ(thread.shot(ui::A)->firstFrame, 7u);
    order.rival = order.settings;
    order.rival->seed = 1;
    thread.order(order);
    expectOnTheWay(ui::B, 8);
    expectOnTheWay(ui::A, 8);
    order.paused = true;
    thread.order(order);
    ASSERT_TRUE(comes([&] { return thread.shot(ui::A)->order.paused && thread.shot(ui::B)->order.paused; }));
    EXPECT_EQ(frameOf(thread.shot(ui::A)), frameOf(thread.shot(ui::B)));

    order.paused = false;
    ++order.plays; // from its frame again
    thread.order(order);
    ASSERT_TRUE(comes([&] { return thread.shot(ui::A)->order == order && thread.shot(ui::A)->firstFrame == 7; }));
    order.pose = ui::poseOf(rest, thread.scene()->origin);
    thread.order(order);
    ASSERT_TRUE(comes([&] { return thread.shot(ui::A)->order == order; }));
    EXPECT_NEAR(glm::distance(thread.shot(ui::A)->camera.position, rest.position), 0, 1e-9);
}

// Each study says what is known otherwise: chains follow their law, RGB has no floor, the reference is the picture.
TEST(RenderThread, StudiesAreMeasuredBesideThePictures)
{
    lost = false;
    ui::RenderThread thread(open, "", [] {});
    ui::Order order = small();
    order.settings.method = passes::Method::RestirPt;
    order.settings.shift = passes::Shift::Replay;
    order.settings.spatial = 0;
    order.settings.maxConfidence = 8;
    order.rival = order.settings;
    order.rival->method = passes::Method::RgbRestir;
    order.studies = {.reference = true, .correlation = true, .floor = true};
    order.paused = true; // the pictures: studies have the time to themselves
    thread.order(order);
    const auto known = [&](ui::Side side) { return thread.findings()->curves[side]; };
    ASSERT_TRUE(comes([&] {
        const auto findings = thread.findings();
        return findings->reference && findings->floors[ui::A] && findings->floors[ui::A]->frames >= 64 &&
               findings->floors[ui::B] && known(ui::A) && known(ui::A)->batches >= 4 && known(ui::B) &&
               known(ui::B)->batches >= 4;
    }));
    for (const ui::Side side : {ui::A, ui::B}) {
        ASSERT_EQ(known(side)->curve.points.size(), 3u); // M = 2, 4, 8
        for (const passes::CurvePoint& point : known(side)->curve.points) {
            // Weighted color starts with whole trees, which luminance's own law does not know.
            ASSERT_EQ(point.law.has_value(), side == ui::B || point.frame > 2);
            if (!point.law) continue;
            const double error = std::sqrt(point.autocovariance.varianceOfMean), law = point.law->mean;
            EXPECT_NEAR(point.autocovariance.mean, law, 5 * error + 0.02 * law) << point.frame;
            EXPECT_LT(error, 0.1 * law);
        }
    }
    const double plateau = known(ui::A)->curve.plateau->mean;
    EXPECT_GT(plateau, 0);
    EXPECT_NEAR(known(ui::B)->curve.plateau->mean, 0, 1e-9 * plateau);

    const std::shared_ptr<const ui::Findings> findings = thread.findings();
    const auto meanOf = [](const image::Image& picture) {
        glm::dvec3 sum(0);
        for (const glm::vec3& p : picture.pixels) sum += glm::dvec3(p);
        return (sum.r + sum.g + sum.b) / (3 * double(picture.pixels.size()));
    };
    EXPECT_GT(meanOf(findings->floors[ui::A]->deviation), 0);
    EXPECT_EQ(findings->floors[ui::B]->frames, 0u);
    EXPECT_EQ(meanOf(findings->floors[ui::B]->deviation), 0);
    EXPECT_GT(findings->reference->error.mse, 0);
    const double mean = meanOf(findings->reference->picture);
    order.paused = false;
    thread.order(order);
    ASSERT_TRUE(comes([&] { return thread.shot(ui::B)->frames >= 200; }));
    EXPECT_NEAR(meanOf(thread.shot(ui::B)->picture), mean, 0.03 * mean);

    order.studies.floor = false;
    thread.order(order);
    EXPECT_TRUE(comes([&] { return !thread.findings()->floors[ui::A] && thread.findings()->reference; }));

    order.settings.method = passes::Method::Pt;
    order.rival.reset();
    order.studies = {.savings = 1};
    thread.order(order);
    ASSERT_TRUE(comes([&] { return thread.findings()->savings && thread.findings()->savings->frames >= 8; }));
    EXPECT_FALSE(thread.findings()->reference);
    const ui::Savings savings = *thread.findings()->savings;
    EXPECT_GT(savings.everythingBytes, savings.neededBytes); // rows for texture coordinates, at least
    EXPECT_GT(savings.everythingMilliseconds, 0);
    EXPECT_GT(savings.neededMilliseconds, 0);
}
