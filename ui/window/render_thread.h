#pragma once
// Rendering away from the window: a thread with its own device does what was ordered last and hands over pictures.
// Nothing here waits for a frame, a compiler or a loader except the thread itself.

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "engine/gpu/gpu.h"
#include "engine/image/image.h"
#include "passes/renderer.h"
#include "ui/cli/device_options.h"
#include "ui/window/pose.h"

namespace ui
{

// What the window wants to see.
struct Order {
    std::string scene; // empty: nothing yet
    passes::Settings settings;
    std::optional<Pose> pose; // empty: the camera that the settings name
    bool moving = false;      // the camera: single frames at a part of the resolution, no film
    bool paused = false;
    uint64_t restarts = 0; // how often "from the first frame again" was asked for
    uint64_t steps = 0;    // how many single frames were asked for while paused
    bool operator==(const Order&) const = default;
};

// What a scene offers to the window.
struct SceneFacts {
    std::string name; // as ordered
    std::vector<scene::Camera> cameras;
    glm::dvec3 origin = {0, 0, 0};
    std::vector<std::string> warnings;
};

// One finished picture and how it came about.
struct Shot {
    image::Image picture;
    Order order; // its settings are the running ones; the size is that of the picture
    uint64_t frames = 0;
    bool single = false; // the last frame alone, not the mean
    passes::RenderStats stats;
    gpu::Adapter adapter;
    double frameMilliseconds = 0; // wall, from frame to frame
    double raysPerSecond = 0;
};

class RenderThread
{
  public:
    // `wake` is called from the thread whenever there is something new.
    RenderThread(const DeviceOptions& device, std::function<void()> wake);
    ~RenderThread(); // ends after the current frame
    RenderThread(const RenderThread&) = delete;
    RenderThread& operator=(const RenderThread&) = delete;

    void order(const Order& order);

    std::shared_ptr<const Shot> shot() const; // the latest; null before the first
    std::shared_ptr<const SceneFacts> scene() const;
    std::string activity() const; // "Building the BVH: 40%"; empty: rendering, or nothing to do
    // Why the last order could not be followed, once; `back` becomes what goes on instead.
    std::optional<std::string> takeFailure(Order& back);

  private:
    void run();
    void follow(const Order& order);
    void load(const Order& order);
    void tune(const Order& order);
    void place(const Order& order);
    void renderAndPublish(const Order& order);
    void fail(const std::string& sentence);
    void say(const std::string& activity);

    DeviceOptions deviceOptions_;
    std::function<void()> wake_;

    mutable std::mutex mutex_; // of all up to thread_
    std::condition_variable changed_;
    Order wanted_;
    bool news_ = false, stop_ = false;
    std::shared_ptr<const Shot> shot_;
    std::shared_ptr<const SceneFacts> sceneFacts_;
    std::string activity_;
    std::optional<std::string> failure_;
    Order good_; // the last order that was followed

    // The thread's own.
    std::unique_ptr<gpu::Device> device_;
    std::unique_ptr<scene::Scene> scene_;
    std::unique_ptr<passes::Renderer> renderer_;
    Order running_;
    uint64_t raysBefore_ = 0;
    std::thread thread_; // last: starts when all else is there
};

} // namespace ui
