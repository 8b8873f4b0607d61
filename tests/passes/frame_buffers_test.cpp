#include "passes/frame_buffers.h"

#include <gtest/gtest.h>

namespace
{

using passes::Color, passes::Method, passes::Settings, passes::Shift;

constexpr uint64_t MIB = uint64_t{1} << 20;
// lavapipe's, of which rows of tables are counted by int, and storage buffers are the smallest that Vulkan allows.
const gpu::Limits LAVAPIPE = {.storageBindingBytes = 128 * MIB, .tableBytes = 2048 * MIB, .memoryBytes = 2048 * MIB};

Settings settingsOf(Method method, Shift shift, uint32_t width, uint32_t height)
{
    return {.method = method, .shift = shift, .width = width, .height = height};
}

uint64_t limitOf(const passes::PixelBuffer& buffer, const gpu::Limits& limits)
{
    return has(buffer.usage, gpu::Usage::Storage) ? std::min(limits.storageBindingBytes, limits.tableBytes)
                                                  : limits.tableBytes;
}

} // namespace

TEST(FrameBuffers, OfEveryMethodFitTheBindingsOfACpuDriverUpTo4K)
{
    for (const Method method : {Method::Pt, Method::RestirPt, Method::RgbRestir, Method::GroupedRestir})
        for (const Shift shift : {Shift::Replay, Shift::Reconnection, Shift::Hybrid})
            for (const uint32_t spatial : {0u, 3u, 8u}) {
                Settings settings = settingsOf(method, shift, 3840, 2160);
                settings.spatial = spatial;
                for (const passes::PixelBuffer& buffer : passes::pixelBuffers(settings)) {
                    const uint64_t bytes = buffer.bytes * settings.width * settings.height;
                    EXPECT_LE(bytes, limitOf(buffer, LAVAPIPE)) << buffer.name << ", K = " << spatial;
                    EXPECT_LE(bytes / 16, uint64_t{INT32_MAX}) << buffer.name; // rows are counted by int
                }
                EXPECT_EQ(passes::maxRuns(LAVAPIPE, settings) > 0,
                          passes::bytesPerPixel(settings) * settings.width * settings.height <=
                              LAVAPIPE.memoryBytes / 4);
            }
}

TEST(FrameBuffers, TakeOfAPixelWhatTheDocumentsSay)
{
    const auto bytes = [](Method method, Shift shift, Color color = Color::Weighted) {
        Settings settings = settingsOf(method, shift, 640, 360);
        settings.color = color;
        return passes::bytesPerPixel(settings);
    };
    EXPECT_EQ(bytes(Method::Pt, Shift::Hybrid), 80u);
    EXPECT_EQ(bytes(Method::RestirPt, Shift::Hybrid), 312u);
    EXPECT_EQ(bytes(Method::RestirPt, Shift::Hybrid, Color::Chosen), 296u);
    EXPECT_EQ(bytes(Method::RestirPt, Shift::Hybrid, Color::Variate), 328u);
    EXPECT_EQ(bytes(Method::RestirPt, Shift::Replay), 216u);
    EXPECT_EQ(bytes(Method::RgbRestir, Shift::Hybrid), 488u);
    EXPECT_EQ(bytes(Method::RgbRestir, Shift::Replay), 296u);
    EXPECT_EQ(bytes(Method::GroupedRestir, Shift::Hybrid), 520u);
    // Mutations: a row of densities in each set, and one a neighbor; none where all are 1.
    for (const Method method : {Method::RestirPt, Method::RgbRestir, Method::GroupedRestir})
        for (const Shift shift : {Shift::Replay, Shift::Hybrid}) {
            Settings settings = settingsOf(method, shift, 640, 360);
            settings.mutate = passes::Mutate::Free;
            EXPECT_EQ(passes::bytesPerPixel(settings) - bytes(method, shift),
                      shift == Shift::Replay ? 0u : 32u + 3 * 16);
        }
}

TEST(FrameBuffers, KeepWhatTheNextFrameNeeds)
{
    const auto lasting = [](Method method, Color color = Color::Weighted) {
        Settings settings = settingsOf(method, Shift::Hybrid, 64, 36);
        settings.color = color;
        std::vector<std::string> names;
        for (const passes::PixelBuffer& buffer : passes::pixelBuffers(settings))
            if (buffer.lasts) names.emplace_back(buffer.name);
        return names;
    };
    EXPECT_EQ(lasting(Method::Pt), (std::vector<std::string>{"Color", "Film"}));
    EXPECT_EQ(lasting(Method::RgbRestir),
              (std::vector<std::string>{"Surfaces", "Color", "Film", "History", "HistoryPaths", "HistoryConfidences"}));
    EXPECT_EQ(lasting(Method::RestirPt, Color::Variate),
              (std::vector<std::string>{"Surfaces", "Color", "Film", "History", "HistoryPaths", "HistoryConfidences",
                                        "HistoryColor"}));
}

TEST(FrameBuffers, HoldAsManyRunsAsMemoryAndWorkgroupsAllow)
{
    EXPECT_EQ(passes::maxRuns(LAVAPIPE, settingsOf(Method::Pt, Shift::Hybrid, 1024, 1024)), 512u / 80);
    EXPECT_EQ(passes::maxRuns(LAVAPIPE, settingsOf(Method::Pt, Shift::Hybrid, 1, 16)), 65535u / 2);
    EXPECT_EQ(passes::maxRuns(LAVAPIPE, settingsOf(Method::Pt, Shift::Hybrid, 32768, 32768)), 0u);
    gpu::Limits large = LAVAPIPE; // where the words of confidence end first
    large.memoryBytes = uint64_t{1} << 40;
    Settings replay = settingsOf(Method::RestirPt, Shift::Replay, 1024, 1024);
    replay.spatial = 0;
    EXPECT_EQ(passes::maxRuns(large, replay), 128u / 4);
}

TEST(FrameBuffers, FitStorageBindingsInSmallPictures)
{
    const auto fit = [](Method method, uint32_t width, uint32_t height, uint32_t runs = 1) {
        return passes::fitStorageBindings(LAVAPIPE, settingsOf(method, Shift::Hybrid, width, height), runs);
    };
    EXPECT_TRUE(fit(Method::RgbRestir, 1280, 720));
    EXPECT_FALSE(fit(Method::RgbRestir, 1920, 1080));
    EXPECT_TRUE(fit(Method::Pt, 1920, 1080, 2));
    EXPECT_FALSE(fit(Method::Pt, 1920, 1080, 3));
    EXPECT_TRUE(fit(Method::Pt, 2048, 2048)); // to the last byte
    EXPECT_FALSE(fit(Method::Pt, 2049, 2048));
}
