#pragma once
// What moves from frame to frame besides random numbers: the camera, the scene, both, or nothing.

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/scene/scene.h"
#include "passes/camera_path.h"
#include "passes/renderer.h"

namespace passes
{

// Into the `length` seconds of what plays: with `loop`, from the last key on, the first comes again; else the last is
// held.
double playedAt(double seconds, double length, bool loop);

// Which animations of a scene play, and how fast.
struct Playback {
    std::vector<uint32_t> animations; // as chooseAnimations() gives them
    double start = 0;                 // seconds, of frame 0
    double step = 1.0 / 30;           // seconds from frame to frame; 0: they rest
    bool loop = true;                 // as playedAt() has it

    double secondsAt(int64_t frame, const scene::Motion& motion) const; // of the animations
};

class Sequence
{
  public:
    Sequence() = default;
    Sequence(CameraAt cameraAt) : cameraAt_(std::move(cameraAt)) {} // the scene rests
    // `scene`, which the renderers were made for, is posed in place; it must live as long. Where there is no
    // `cameraAt`, `camera`, an index, is where its node has it.
    Sequence(scene::Scene& scene, Playback playback, uint32_t camera, CameraAt cameraAt = {});

    bool moves() const { return cameraAt_ || (scene_ && playback_.step != 0); }
    bool sceneMoves() const { return scene_ != nullptr; } // or has been posed: then renderers are made so
    // Frames before 0 have the camera of frame 0.
    void bring(Renderer& renderer, int64_t frame) const;

  private:
    CameraAt cameraAt_;
    scene::Scene* scene_ = nullptr;
    Playback playback_;
    uint32_t camera_ = 0;
};

} // namespace passes
