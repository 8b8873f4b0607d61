#include "passes/frame_plan.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/motion.h"
#include "engine/scene/procedural.h"
#include "passes/frame_buffers.h"
#include "tests/support/gpu_fixture.h"

namespace
{

using Names = std::vector<std::string>;
using passes::Method;

class FramePlan : public GpuTest
{
  protected:
    static passes::SceneOnDevice cornell(scene::FeatureSet set = scene::FeatureSet::Needed)
    {
        const scene::Scene scene = scene::makeCornell();
        return {device(), scene, scene.cameras.at(0), {.featureSet = set}};
    }
    static passes::SceneOnDevice movingCornell()
    {
        scene::Scene scene = scene::makeCornell();
        scene.motion = std::make_shared<scene::Motion>();
        return {device(), scene, scene.cameras.at(0), {.moves = true}};
    }
    static std::string nameOf(const std::string& shader, const passes::Variant& variant)
    {
        return (variant.SAME_VIEW ? "=" : variant.BETWEEN_WORLDS ? "~" : "") + shader;
    }
    // Names of what runs; "=" for a variant without shifts, "~" for one between worlds.
    static Names stages(const passes::SceneOnDevice& scene, const passes::Settings& settings,
                        const passes::FrameState& frame)
    {
        Names names;
        for (const passes::PlannedStage& stage : passes::framePlan(scene, settings, 1))
            if (stage.runs(frame)) names.push_back(nameOf(stage.shader, stage.variant));
        return names;
    }
};

TEST_F(FramePlan, IsThePapersFrame)
{
    const passes::SceneOnDevice scene = cornell();
    passes::Settings settings;
    EXPECT_EQ(stages(scene, settings, {}), (Names{"primary", "path_trace", "accumulate"}));
    EXPECT_EQ(stages(scene, settings, {.hitsKnown = true, .history = true, .sameView = true}),
              (Names{"path_trace", "accumulate"}));
    settings.method = Method::RgbRestir;
    EXPECT_EQ(stages(scene, settings, {}),
              (Names{"primary", "canonical", "spatial_trace", "spatial_gather", "accumulate"}));
    EXPECT_EQ(stages(scene, settings, {.history = true}),
              (Names{"primary", "canonical", "temporal", "spatial_trace", "spatial_gather", "accumulate"}));
    settings.spatial = 0;
    EXPECT_EQ(stages(scene, settings, {.hitsKnown = true, .history = true, .sameView = true}),
              (Names{"canonical", "=temporal", "spatial_gather", "accumulate"}));
}

// At rest what canonical walks is proposed to history's samples; else a walk in the frame before is, in its world.
TEST_F(FramePlan, MutatesHistoryWhereThereIsOne)
{
    const passes::SceneOnDevice scene = movingCornell();
    const passes::Settings settings{.method = Method::RestirPt, .spatial = 0, .mutate = passes::Mutate::Free};
    EXPECT_EQ(stages(scene, settings, {}), (Names{"primary", "canonical", "spatial_gather", "accumulate"}));
    EXPECT_EQ(stages(scene, settings, {.hitsKnown = true, .history = true, .sameView = true}),
              (Names{"=canonical", "=temporal", "spatial_gather", "accumulate"}));
    EXPECT_EQ(stages(scene, settings, {.history = true}),
              (Names{"primary", "canonical", "mutate", "temporal", "spatial_gather", "accumulate"}));
    EXPECT_EQ(stages(scene, settings, {.history = true, .moved = true}),
              (Names{"primary", "canonical", "~mutate", "~temporal", "spatial_gather", "accumulate"}));
}

// Temporal reuse turns to the previous world where the scene has moved, and only there: nothing else ever does.
TEST_F(FramePlan, ReusesBetweenWorldsExactlyWhereTheSceneHasMoved)
{
    const passes::SceneOnDevice still = cornell(), moving = movingCornell();
    const passes::Settings settings{.method = Method::RestirPt, .spatial = 2};
    for (const bool history : {false, true})
        for (const auto& [sameView, moved] : {std::pair(false, false), {true, false}, {false, true}}) {
            const Names names = stages(moving, settings, {.history = history, .sameView = sameView, .moved = moved});
            EXPECT_EQ(std::ranges::count(names, "~temporal"), history && moved);
            EXPECT_EQ(std::ranges::count(names, "=temporal"), history && sameView);
            EXPECT_EQ(std::ranges::count(names, "temporal"), history && !sameView && !moved);
        }
    for (const passes::SceneOnDevice* scene : {&still, &moving})
        for (const Method method : {Method::Pt, Method::RestirPt})
            for (const passes::PlannedStage& stage : passes::framePlan(*scene, {.method = method}, 1)) {
                EXPECT_EQ(stage.variant.TWO_WORLDS, scene == &moving);
                const bool reuses = std::string(stage.shader) == "temporal";
                EXPECT_LE(stage.variant.BETWEEN_WORLDS, reuses) << stage.shader;
            }
}

TEST_F(FramePlan, KeepsTheOrderOfTheList)
{
#define ADD_NAME(INDEX, NAME, SHADER) SHADER,
    const Names all = {FRAME_STAGES(ADD_NAME)};
#undef ADD_NAME
    EXPECT_EQ(all.size(), shared::STAGE_COUNT);
    const passes::SceneOnDevice scene = cornell();
    for (const Method method : {Method::Pt, Method::RestirPt, Method::RgbRestir, Method::GroupedRestir}) {
        auto last = all.begin();
        for (const passes::PlannedStage& stage :
             passes::framePlan(scene, {.method = method, .mutate = passes::Mutate::Free}, 1)) {
            last = std::find(last, all.end(), stage.shader);
            EXPECT_NE(last, all.end()) << stage.shader;
        }
    }
}

TEST_F(FramePlan, HasAThreadForEachPixelOfAllRunsAndForEachNeighbor)
{
    const passes::Settings settings{.method = Method::RestirPt, .spatial = 5, .width = 20, .height = 10};
    for (const passes::PlannedStage& stage : passes::framePlan(cornell(), settings, 3)) {
        EXPECT_EQ(stage.threads.x, std::string(stage.shader) == "spatial_trace" ? 100u : 20u);
        EXPECT_EQ(stage.threads.y, 30u);
    }
}

TEST_F(FramePlan, WritesAsStorageBuffersWhatTheseHold)
{
    const passes::SceneOnDevice scene = cornell();
    for (const uint32_t width : {64u, 16384u})
        for (const uint32_t runs : {1u, 1000u}) {
            const passes::Settings settings{.method = Method::RgbRestir, .width = width, .height = 256};
            for (const passes::PlannedStage& stage : passes::framePlan(scene, settings, runs))
                EXPECT_EQ(stage.variant.STORES_IN_STORAGE,
                          passes::fitStorageBindings(device().limits(), settings, runs))
                    << stage.shader;
        }
}

TEST_F(FramePlan, TellsThoseWhoCompileAheadWhatAFrameAfterTheFirstRuns)
{
    const auto listed = [](const passes::SceneOnDevice& scene, const passes::Settings& settings, bool cameraMoves,
                           bool sceneMoves = false) {
        Names names;
        for (const auto& [name, variant] : passes::stagesOf(scene, {&settings, 1}, cameraMoves, sceneMoves))
            names.push_back(nameOf(name, variant));
        return names;
    };
    const passes::SceneOnDevice scene = cornell(), everything = cornell(scene::FeatureSet::Everything);
    passes::Settings settings{.method = Method::RestirPt, .spatial = 0};
    const Names still{"primary", "canonical", "=temporal", "spatial_gather", "accumulate"};
    const Names moving{"primary", "canonical", "temporal", "spatial_gather", "accumulate"};
    EXPECT_EQ(listed(scene, settings, false), still);
    EXPECT_EQ(listed(scene, settings, true), moving);
    EXPECT_EQ(listed(everything, settings, false), moving);
    const Names between{"primary", "canonical", "~temporal", "spatial_gather", "accumulate"};
    EXPECT_EQ(listed(movingCornell(), settings, false), still); // while it pauses
    EXPECT_EQ(listed(movingCornell(), settings, false, true), between);
    EXPECT_EQ(listed(movingCornell(), settings, true, true), between);
    settings.pixelFilter = passes::PixelFilter::Box;
    EXPECT_EQ(listed(scene, settings, false), moving);
    settings.temporal = false;
    EXPECT_EQ(listed(scene, settings, false), (Names{"primary", "canonical", "spatial_gather", "accumulate"}));
}

} // namespace
