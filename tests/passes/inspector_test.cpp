// What the inspector reads against what is known otherwise: counters, definitions, and how histories grow.

#include "passes/inspector.h"

#include "engine/base/error.h"
#include "engine/scene/procedural.h"
#include "tests/support/gpu_fixture.h"

#include <set>

namespace
{

class InspectorTest : public RendererFixture
{
  protected:
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

TEST_F(InspectorTest, ThePathTracerHasNothingToInspect)
{
    passes::Renderer renderer(device(), scene_, small(passes::Method::Pt));
    EXPECT_THROW(passes::Inspector{renderer}, Error);
}

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
    for (const shared::Inspection& seen : inspector.read()) {
        tried += seen.lengthAndShifts >> 16 & 0xff;
        failed += seen.lengthAndShifts >> 24;
        EXPECT_LE(seen.lengthAndShifts & 0xffff, settings.maxBounces);
    }
    const passes::RenderStats stats = renderer.stats();
    EXPECT_EQ(tried, 2 * sum(stats.shifts));
    EXPECT_EQ(tried - failed, 2 * stats.shifts.at("done"));
    EXPECT_GT(failed, 0u);
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
        const std::vector<shared::Inspection> all = inspector.read();
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
