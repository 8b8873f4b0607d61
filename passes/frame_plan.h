#pragma once
// What a frame consists of: the stages in their order. The renderer runs the list; who compiles ahead reads it.

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/gpu/gpu.h"
#include "passes/scene_on_device.h"

namespace passes
{

// What is known when a frame begins.
struct FrameState {
    bool hitsKnown = false; // all its rays are those of a frame before: what they hit is stored
    bool history = false;   // there are reservoirs of the frame before, to be reused
    bool sameView = false;  // each pixel sees what it saw in that frame
    bool moved = false;     // the scene has moved since that frame
};

struct PlannedStage {
    const char* shader;
    Variant variant;
    gpu::Threads threads;
    bool (*runs)(const FrameState&) = [](const FrameState&) { return true; };
};
using FramePlan = std::vector<PlannedStage>;

FramePlan framePlan(const SceneOnDevice& scene, const Settings& settings, uint32_t runs);

// What frames with any of these settings compile, for those who compile ahead.
using StageList = std::vector<std::pair<std::string, Variant>>;
StageList stagesOf(const SceneOnDevice& scene, std::span<const Settings> list, bool cameraMoves = false,
                   bool sceneMoves = false);

} // namespace passes
