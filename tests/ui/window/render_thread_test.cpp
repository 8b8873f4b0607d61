// What happens between the window and the device when things take long or break.

#include "ui/window/render_thread.h"

#include "engine/gpu/vulkan.h"

#include <atomic>
#include <chrono>
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
    ui::Order order{.scene = "cornell"};
    order.settings.width = 32;
    order.settings.height = 18;
    order.settings.maxBounces = 1;
    return order;
}

bool comes(const std::function<bool()>& condition)
{
    for (int i = 0; i < 6000; ++i, std::this_thread::sleep_for(10ms))
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
