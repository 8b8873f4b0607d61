#pragma once
// Where a case is rendered: the method on trial and its truth, run by run.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/gpu/gpu.h"
#include "passes/camera_path.h"
#include "passes/renderer.h"
#include "tests/hunt/case.h"
#include "tests/support/tile_tests.h"

namespace hunt
{

// Pixels of one independent run, rows from the top.
using TakeRun = std::function<void(std::span<const glm::vec3>)>;

class Stand
{
  public:
    // The pool outlives stands, so that cases of a session compile once.
    Stand(gpu::Device& device, const std::shared_ptr<passes::PipelinePool>& pipelines, const Case& c);

    void runs(uint64_t seed, uint64_t count, const TakeRun& take); // of the method on trial; at least so many
    void frames(uint64_t seed, uint64_t count,
                const TakeRun& take); // of the path tracer where the last frame is seen from
    // Of float64. With `leastPick` without the lights that the path tracer picks with a smaller probability.
    support::PixelEstimates reference(uint64_t seed, uint64_t samples, double leastPick = 0) const;
    double leastPick() const; // of all lights
    // Of these pixels the center lies on an edge, and what float64 sees there is a matter of its last bit.
    std::vector<bool> undefinedPixels() const;

    uint32_t batch() const { return trial_->runs(); } // runs that are rendered at once
    double chancesPerRun() const;                     // frames that a run of the trial rests on
    const std::map<std::string, uint64_t>& nonFinite() const { return nonFinite_; } // values so far, by stage

  private:
    void showFrame(uint32_t frame); // camera and pose
    void take(passes::Renderer& renderer, const TakeRun& take);

    const Case& case_;
    passes::CameraAt cameraAt_;
    std::vector<scene::Scene> poses_; // by frame, of a case that moves
    std::unique_ptr<passes::Renderer> trial_, truth_;
    std::map<std::string, uint64_t> nonFinite_;
};

} // namespace hunt
