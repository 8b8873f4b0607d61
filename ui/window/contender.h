#pragma once
// One of the settings that are compared: its renderer, and its picture so far.

#include <memory>

#include "passes/camera_path.h"
#include "passes/inspector.h"
#include "ui/window/order.h"

namespace ui
{

// What a side of the order compiles, those stages that inspect it included.
passes::StageList stagesFor(const Order& order, Side side, const passes::Renderer& renderer);

class Contender
{
  public:
    // `scene` is in the pose of the renderer.
    Contender(std::unique_ptr<passes::Renderer> renderer, const scene::Scene& scene, const Order& order, Side side);

    // Follows the order from the next frame on. Anything that changes the estimate starts over: a mean over two
    // settings would be the picture of neither, and no command line could repeat it. While the camera moves, reuse goes
    // on from frame to frame. Throws Error, and goes on as before: such as a picture too large for the device.
    void follow(const Order& order, const scene::Scene& scene);
    bool runs(const Order& order) const; // what the order wants of this side
    void recompile();                    // throws Error: a shader that does not compile
    // From the next frame on: a frame of the timeline, that is, the scene (if it moves) in another pose, and the camera
    // where that or its path has it. Reuse goes on.
    void show(const scene::Scene& posed, std::optional<double> seconds, uint64_t frame);
    void startOver(); // from the first frame again

    // Renders for a sixtieth of a second; `once`: one frame. Throws Error: the device is lost.
    void render(bool once);
    ShotPointer shot(const Order& order); // of the film as it is; with what the order that it follows wants inspected

    passes::Renderer& renderer() { return *renderer_; }
    double seconds() const { return seconds_; } // of rendering since it last started over
    uint64_t frames() const { return renderer_->frameCount(); }

  private:
    void place(const Order& order, const scene::Scene& scene);
    void inspect(Shot& shot);

    std::unique_ptr<passes::Renderer> renderer_;
    std::unique_ptr<passes::Inspector> inspector_;
    Side side_;
    Order followed_;
    std::optional<double> firstSeconds_;  // of the scene, in the first frame
    uint64_t frame_ = 0, firstFrame_ = 0; // of the timeline: the next one's, the first one's
    passes::CameraAt cameraAt_;           // the order's path; empty: not needed so far
    scene::Camera camera_;
    uint64_t run_ = 0, raysBefore_ = 0;
    double seconds_ = 0, frameMilliseconds_ = 0, raysPerSecond_ = 0;
};

} // namespace ui
