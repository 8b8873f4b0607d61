#pragma once
// The paper's experiment: how strongly the frames M-1 and M of temporal reuse depend on each other, over independent
// runs, and what the closed form says about it (ARCHITECTURE.md, "Decisions about correlate").

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "engine/base/batches.h"
#include "passes/camera_path.h"
#include "passes/renderer.h"

namespace passes
{

// After every frame; false: stop here.
using Tick = std::function<bool()>;

// Frames M-1 and M of a batch of runs, averaged over pixels and channels.
struct ChainPoint {
    uint32_t frame = 0;                    // M, counted from 1
    uint64_t pixels = 0;                   // of one run, that counted
    statistics::BatchValue autocovariance; // radiance^2
    statistics::BatchValue variance;       // of frame M alone, radiance^2
    bool operator==(const ChainPoint&) const = default;
};

// Renders frames 1 to `lastFrame` of a renderer's runs and takes the points M = 2, 4, 8, ...: all from one chain, since
// M_c >= M does not bind before. With a moving camera a pixel of frame M pairs with the one that saw the same point in
// frame M-1; pixels without one do not count. A stopped chain has the points that it reached.
std::vector<ChainPoint> measureChain(Renderer& renderer, uint32_t lastFrame, const CameraAt& cameraAt,
                                     const Tick& tick);

// Single frames without reuse, of a batch of runs: what the law of the chain is made of.
struct FrameLaw {
    statistics::BatchValue variance; // of a frame's color, mean over pixels and channels: sigma^2 for the path tracer
    statistics::BatchValue plateau;  // P, likewise: what is left of the autocovariance however long the history is
    std::vector<glm::dvec3> floor;   // P by pixel and channel
    std::vector<glm::dvec3> mean;    // color, without what is seen directly
    bool operator==(const FrameLaw&) const = default;
};

// `targets[c]` is the target of the reservoir that channel c is resolved from (resolvingTargets); for the path tracer,
// each channel itself. `emission` is what each pixel sees directly (one run's picture): no part of what is resampled.
// Nothing when `tick` stops it.
std::optional<FrameLaw> measureLaw(Renderer& renderer, uint32_t frames, const std::array<glm::vec3, 3>& targets,
                                   const image::Image& emission, const Tick& tick);

std::array<glm::vec3, 3> resolvingTargets(Method method);

// Whether every channel has a reservoir of its own, so that a resting camera's chain is the mean of the path tracer's
// frames.
bool accumulates(Method method);

// The autocovariance between frames M-1 and M <= M_c + 1 that the law predicts: V / M + (1 - 2 / M) P.
statistics::BatchValue predictedAutocovariance(const FrameLaw& law, double frame);

} // namespace passes
