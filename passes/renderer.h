#pragma once
// Renders frames of one scene with one set of settings. framePlan() is the page to read first (passes/frame_plan.cpp).

#include <array>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/gpu/gpu.h"
#include "engine/image/image.h"
#include "engine/scene/scene.h"
#include "passes/film.h"
#include "passes/frame_buffers.h"
#include "passes/frame_plan.h"
#include "passes/scene_on_device.h"
#include "passes/settings.h"
#include "passes/stage.h"

namespace passes
{

// Counters and times so far.
struct RenderStats {
    std::map<std::string, double> stageMilliseconds; // device time per frame, by stage
    std::map<std::string, uint64_t> rays;   // since the last reset: primary, bounce, shadow, replay, reconnection
    std::map<std::string, uint64_t> shifts; // by outcome, since the last reset
    double treesPerPixel =
        0; // path trees among the reservoirs of a pixel that all hold a sample: 1 when all agree; 0: one reservoir
    std::map<std::string, uint64_t> mutations; // of history's samples: proposed, accepted
    std::map<std::string, uint64_t> nonFinite; // values found not finite (and counted as 0), by stage
    double tablesSeconds = 0;                  // scene -> tables, without the BVH
    double bvhSeconds = 0;
    double compileSeconds = 0;
    scene::BvhStats bvh;
    scene::LightCounts lights;
    uint64_t memoryBytes = 0; // of all buffers of the device
    uint64_t sceneBytes = 0;
    double bytesPerPixel = 0;                   // of all buffers that grow with the picture
    double reservoirBytes = 0;                  // of those: per reservoir and pixel, both sets
    std::map<std::string, std::string> variant; // what is compiled in: describe(Variant)
};

// Of all kinds or stages.
uint64_t sumOf(const std::map<std::string, uint64_t>& counts);

// All that the next frame needs of those before it.
struct RendererState {
    uint64_t frames = 0;        // on the film
    uint64_t historyFrames = 0; // of reservoirs that the next frame may reuse
    shared::CameraUniform camera = {}, previousCamera = {};
    std::vector<std::pair<std::string, std::vector<std::byte>>> buffers; // by name, as on the device
};

class Renderer
{
  public:
    // Independent `runs` of the picture lie below each other in what is rendered and read, width x (height * runs); the
    // first is what a lone run with this seed gives, to the bit.
    Renderer(gpu::Device& device, const scene::Scene& scene, const Settings& settings, const SceneOptions& options = {},
             uint32_t runs = 1);
    // Another renderer of the sibling's scene on its device, seen by its camera, that shares the scene's memory, so
    // that methods can be compared in turns. The environment must be the sibling's. If the scene moves, it has the
    // sibling's pose until setScene() gives it another.
    Renderer(const Renderer& sibling, const Settings& settings, uint32_t runs = 1);

    void renderFrame();                                 // encodes and submits one frame; keeps at most two in flight
    uint64_t frameCount() const { return frameCount_; } // submitted since the last reset
    uint32_t runs() const { return runs_; }
    void reset();                                // forgets all frames
    void forgetHistory() { historyFrames_ = 0; } // the next frame reuses none before it; the film goes on
    // Which random numbers the next frame has; those after it count on. After a reset: 0.
    void setFrame(uint32_t number) { nextFrame_ = number; }
    // From the next frame on; does what the settings' `Change` says. The scene, its environment and the camera stay.
    void apply(const Settings& settings);
    void recompile(); // takes all stages from pipelines() anew, once that holds other ones; starts over
    const Settings& settings() const { return settings_; }
    void setCamera(const scene::Camera& camera); // from the next frame on; the film goes on averaging
    // From the next frame on: the scene in another pose, scene::pose() of the one that the renderer was made for, at
    // `seconds` of whatever moves it. Does nothing where it is there already.
    void setScene(const scene::Scene& posed, double seconds);
    std::optional<double> sceneSeconds() const { return sceneSeconds_; } // of the last setScene()
    void wait();                                                         // until all submitted frames are done

    image::Image read(const Output& output); // waits; in scene units
    // Waits. For each pixel of the first run the index of the one that saw the same point in the frame before the last,
    // or shared::NO_NEIGHBOR: as temporal reuse finds it. Needs two frames, and no setScene() since the last one.
    std::vector<uint32_t> readPreviousPixels();
    RenderStats stats(); // waits

    // A stage of the caller's own over what frames leave behind, and over `more`; it lives until apply().
    std::unique_ptr<Stage> makeStage(const std::string& name, const Variant& variant, const NamedBuffers& more = {});
    const SceneOnDevice& scene() const { return *scene_; }
    Variant variant() const { return scene_->variant(settings_); }
    const std::shared_ptr<PipelinePool>& pipelines() { return scene_->pipelines; }
    gpu::Device& device() { return device_; }
    // For later and another process: a renderer of an equal scene with equal settings (but for frames, seconds and
    // average) on an equal device goes on from a state to the bit. restore() throws Error when it does not fit. A scene
    // that moves has no pose then: setScene() gives it that of the last frame, before any other.
    RendererState save(); // waits
    void restore(const RendererState& state);

  private:
    void createBuffers();
    void createStages();
    const Stage& planned(size_t i);
    bool seesTheSame(const std::optional<shared::CameraUniform>& from) const;
    void tune();
    void encodeFrame(gpu::CommandEncoder& encoder, const FrameState& state);
    void finishOldest(); // of the frames in flight
    uint32_t pictureHeight() const { return settings_.height * runs_; }
    std::vector<const gpu::Buffer*> lastingBuffers() const;

    gpu::Device& device_;
    Settings settings_;
    uint32_t runs_;
    std::shared_ptr<SceneOnDevice> scene_;
    gpu::Buffer frameUniform_, counters_, previousPixels_;
    FrameBuffers buffers_;
    FramePlan plan_;
    std::vector<std::unique_ptr<Stage>> stages_;      // of the plan; null until needed
    std::array<std::unique_ptr<Stage>, 2> reproject_; // [1]: from a frame in which the scene was another
    double compileSeconds_ = 0;

    shared::FrameUniform frame_ = {};
    std::optional<shared::CameraUniform> hitsFrom_; // the camera that the frame's half of Surfaces was traced from
    uint32_t lastWorld_ = 0;                        // that a frame has shown
    bool moved_ = false;                            // before the last frame
    bool hasPose_ = true;
    std::optional<double> sceneSeconds_;
    uint32_t nextFrame_ = 0;                      // its number, for random numbers
    uint64_t frameCount_ = 0, historyFrames_ = 0; // the latter of reservoirs that the next frame may reuse
    std::map<std::string, double> milliseconds_;  // summed over timedFrames_
    uint64_t timedFrames_ = 0;
    std::deque<gpu::Submission> inFlight_;
};

} // namespace passes
