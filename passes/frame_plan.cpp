#include "passes/frame_plan.h"

#include "passes/frame_buffers.h"

namespace passes
{

// The paper's four stages, between what a pixel sees and what the film keeps.
FramePlan framePlan(const SceneOnDevice& scene, const Settings& settings, uint32_t runs)
{
    const gpu::Threads pixels = {settings.width, settings.height * runs};
    const gpu::Threads slots = {pixels.x * settings.spatial, pixels.y};
    Variant variant = scene.variant(settings);
    variant.STORES_IN_STORAGE = fitStorageBindings(scene.device.limits(), settings, runs);
    Variant sameView = variant; // shifts between the two frames are identities, and left out
    sameView.SAME_VIEW = true;
    Variant moved = variant;
    moved.BETWEEN_WORLDS = true;

    FramePlan plan = {{"primary", variant, pixels, [](const FrameState& frame) { return !frame.hitsKnown; }}};
    if (settings.method == Method::Pt) {
        plan.push_back({"path_trace", variant, pixels});
    } else {
        using Frame = const FrameState&;
        if (settings.mutate == Mutate::Off) {
            plan.push_back({"canonical", variant, pixels});
        } else {
            plan.push_back({"canonical", variant, pixels, [](Frame f) { return !(f.history && f.sameView); }});
            plan.push_back({"canonical", sameView, pixels, [](Frame f) { return f.history && f.sameView; }});
            plan.push_back({"mutate", variant, pixels, [](Frame f) { return f.history && !f.sameView && !f.moved; }});
            plan.push_back({"mutate", moved, pixels, [](Frame f) { return f.history && f.moved; }});
        }
        plan.push_back({"temporal", variant, pixels, [](Frame f) { return f.history && !f.sameView && !f.moved; }});
        plan.push_back({"temporal", sameView, pixels, [](Frame f) { return f.history && f.sameView; }});
        plan.push_back({"temporal", moved, pixels, [](Frame f) { return f.history && f.moved; }});
        if (settings.spatial > 0) plan.push_back({"spatial_trace", variant, slots});
        plan.push_back({"spatial_gather", variant, pixels});
    }
    plan.push_back({"accumulate", variant, pixels});
    return plan;
}

StageList stagesOf(const SceneOnDevice& scene, std::span<const Settings> list, bool cameraMoves, bool sceneMoves)
{
    StageList stages;
    for (const Settings& settings : list) {
        const FrameState frame{.history = settings.temporal,
                               .sameView = !cameraMoves && !sceneMoves && scene.viewRepeats(settings),
                               .moved = sceneMoves};
        for (const PlannedStage& stage : framePlan(scene, settings, 1))
            if (stage.runs(frame)) stages.emplace_back(stage.shader, stage.variant);
    }
    return stages;
}

} // namespace passes
