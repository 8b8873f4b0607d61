// What happens between the window and the device when things take long or break.
// Covers ui/window/compile_ahead.cpp, ui/window/contender.cpp.

#include "ui/window/render_thread.h"

#include "engine/gpu/vulkan.h"
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

// The pose is a part of the scene: another time is loaded, and a film of the other pose begins.
TEST(RenderThread, AnotherTimeShowsAnotherPose)
{
    lost = false;
    TinyGltf file;
    file.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
    file.json["nodes"].push_back({{"camera", 0}, {"translation", {0.4, 0.4, 2}}});
    file.json["scenes"][0]["nodes"].push_back(1);
    file.material()["emissiveFactor"] = {1, 1, 1};
    file.animate({{"node", 0}, {"path", "translation"}}, {0, 2}, {0, 0, 0, 9, 0, 0}, "VEC3");
    file.load(); // writes it
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
