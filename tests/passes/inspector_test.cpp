// What the inspector reads against what is known otherwise: counters, definitions, and how histories grow.

#include "passes/inspector.h"

#include "engine/scene/procedural.h"
#include "tests/support/gpu_fixture.h"

#include <set>

namespace
{

class InspectorTest : public GpuTest
{
  protected:
    void SetUp() override
    {
        GpuTest::SetUp();
        if (!IsSkipped() && device().adapter().name.find("SwiftShader") != std::string::npos)
            GTEST_SKIP() << "SKIPPED ON SwiftShader: compiling one renderer takes minutes there";
    }
    static passes::Settings small(passes::Method method)
    {
        passes::Settings settings;
        settings.method = method;
        settings.width = 32;
        settings.height = 24;
        settings.maxBounces = 2;
        return settings;
    }
    static uint64_t sum(const std::map<std::string, uint64_t>& counts)
    {
        uint64_t all = 0;
        for (const auto& [name, count] : counts) all += count;
        return all;
    }
    const scene::Scene scene_ = scene::builtInScenes()[0].make();
};

// One reservoir and one frame: every spatial shift is counted by the stage that made it, too. The inspector counts it
// twice: where it starts and where it arrives.
TEST_F(InspectorTest, ShiftsAreThoseThatTheStagesCounted)
{
    passes::Settings settings = small(passes::Method::RestirPt);
    settings.shift = passes::Shift::Reconnection;
    passes::Renderer renderer(device(), scene_, settings);
    passes::Inspector inspector(renderer);
    renderer.renderFrame();
    uint64_t tried = 0, failed = 0;
    for (const shared::Inspection& seen : inspector.reservoirs()) {
        tried += seen.lengthAndShifts >> 16 & 0xff;
        failed += seen.lengthAndShifts >> 24;
        EXPECT_LE(seen.lengthAndShifts & 0xffff, settings.maxBounces);
    }
    const passes::RenderStats stats = renderer.stats();
    EXPECT_EQ(tried, 2 * sum(stats.shifts));
    EXPECT_EQ(tried - failed, 2 * stats.shifts.at("done"));
    EXPECT_GT(failed, 0u);

    passes::ShiftCounts all{};
    for (const passes::ShiftCounts& counts : inspector.shifts())
        for (size_t i = 0; i < all.size(); ++i) all[i] += counts[i];
    const char* const names[] = {"done", "ended", "joined-earlier", "not-joinable", "hidden", "dark"};
    for (size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], stats.shifts.at(names[i])) << names[i];
    EXPECT_GT(stats.shifts.at("hidden"), 0u);
    EXPECT_GT(stats.shifts.at("not-joinable"), 0u);
}

// A path begins at what its pixel sees and ends at light, with as many scattering events as the reservoir says, also
// when it was drawn by another pixel and reconnected here. Where its light lies in the picture, the picture is bright.
TEST_F(InspectorTest, PathsLeadFromThePixelToLight)
{
    for (const passes::Shift shift : {passes::Shift::Replay, passes::Shift::Hybrid}) {
        passes::Settings settings = small(passes::Method::RgbRestir);
        settings.maxBounces = 3;
        settings.shift = shift;
        passes::Renderer renderer(device(), scene_, settings);
        passes::Inspector inspector(renderer);
        for (int frame = 0; frame < 3; ++frame) renderer.renderFrame();
        const std::vector<shared::Inspection> held = inspector.reservoirs();
        passes::Settings dark = settings;
        dark.method = passes::Method::Pt;
        dark.maxBounces = 0;
        passes::Renderer emitters(renderer, dark);
        emitters.renderFrame();
        const image::Image emission = emitters.readFrame();
        const uint32_t pixels = settings.width * settings.height;
        uint32_t lightsSeen = 0, joined = 0, foreign = 0;
        for (uint32_t pixel = 0; pixel < pixels; pixel += 5) {
            const auto paths = inspector.paths(pixel);
            ASSERT_EQ(paths.size(), 3u);
            for (uint32_t c = 0; c < 3; ++c) {
                const shared::Inspection& seen = held[c * pixels + pixel];
                const std::vector<shared::PathPoint>& path = paths[c];
                if (!(seen.weightSum > 0)) {
                    EXPECT_TRUE(path.empty());
                    continue;
                }
                ASSERT_EQ(path.size(), (seen.lengthAndShifts & 0xffff) + 1) << "pixel " << pixel << ", reservoir " << c;
                EXPECT_EQ(path.back().kind, shared::POINT_LIGHT);
                const float width = float(settings.width), height = float(settings.height);
                EXPECT_NEAR((0.5f + 0.5f * path[0].x / path[0].depth) * width, float(pixel % settings.width) + 0.5f,
                            0.02f);
                EXPECT_NEAR((0.5f - 0.5f * path[0].y / path[0].depth) * height, float(pixel / settings.width) + 0.5f,
                            0.02f);
                joined += seen.leafAndJoint >> 16 > 0;
                foreign += seen.seedPixel != pixel;
                const shared::PathPoint& light = path.back();
                const float x = (0.5f + 0.5f * light.x / light.depth) * width;
                const float y = (0.5f - 0.5f * light.y / light.depth) * height;
                uint32_t bright = 0; // of the pixels that touch this point: its edge is somebody else's
                for (const float dx : {-0.5f, 0.5f})
                    for (const float dy : {-0.5f, 0.5f})
                        if (x + dx >= 0 && y + dy >= 0 && x + dx < width && y + dy < height)
                            bright += emission.at(uint32_t(x + dx), uint32_t(y + dy)).r > 0;
                EXPECT_GT(bright, 0u) << x << ", " << y;
                ++lightsSeen;
            }
        }
        EXPECT_GT(lightsSeen, pixels / 5);
        EXPECT_GT(foreign, pixels / 20);
        if (shift == passes::Shift::Hybrid) EXPECT_GT(joined, pixels / 20);
    }
}

TEST_F(InspectorTest, ThePathTracerHasNoReservoirsButAWalk)
{
    passes::Renderer renderer(device(), scene_, small(passes::Method::Pt));
    passes::Inspector inspector(renderer);
    renderer.renderFrame();
    EXPECT_TRUE(inspector.reservoirs().empty());
    EXPECT_TRUE(inspector.shifts().empty());
    const auto paths = inspector.paths(24 * 32 / 2 + 16);
    ASSERT_EQ(paths.size(), 1u);
    EXPECT_GE(paths[0].size(), 2u);
    for (const shared::PathPoint& point : paths[0]) EXPECT_EQ(point.kind, shared::POINT_SURFACE);
}

TEST_F(InspectorTest, WeightsTreesAndConfidenceAreWhatTheyMean)
{
    passes::Settings settings = small(passes::Method::RgbRestir);
    settings.spatial = 0;
    settings.maxConfidence = 3;
    passes::Renderer renderer(device(), scene_, settings);
    passes::Inspector inspector(renderer);
    const size_t pixels = size_t{settings.width} * settings.height;
    double held = 0, trees = 0;
    for (uint32_t frame = 1; frame <= 6; ++frame) {
        renderer.renderFrame();
        const std::vector<shared::Inspection> all = inspector.reservoirs();
        ASSERT_EQ(all.size(), 3 * pixels);
        uint32_t most = 0;
        for (const shared::Inspection& seen : all) {
            EXPECT_NEAR(seen.weight * seen.target, seen.weightSum, 1e-5f * seen.weightSum);
            most = std::max(most, seen.confidence);
            EXPECT_LT(seen.seedFrame, frame);
            EXPECT_LT(seen.seedPixel, pixels);
        }
        EXPECT_EQ(most, std::min(frame, 4u)); // M_c of history and this frame's own
        for (size_t p = 0; p < pixels; ++p) {
            std::set<std::pair<uint32_t, uint32_t>> seeds;
            bool holds = true;
            for (size_t c = 0; c < 3; ++c) {
                const shared::Inspection& seen = all[c * pixels + p];
                seeds.emplace(seen.seedFrame, seen.seedPixel);
                holds = holds && seen.weightSum > 0;
            }
            held += holds;
            trees += holds ? double(seeds.size()) : 0;
        }
    }
    EXPECT_NEAR(renderer.stats().treesPerPixel, trees / held, 1e-9);
    EXPECT_GT(trees, held); // they do not always agree
}

} // namespace
