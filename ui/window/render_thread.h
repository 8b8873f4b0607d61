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

#include "engine/gpu/shader_watcher.h"
#include "ui/window/compile_ahead.h"
#include "ui/window/contender.h"
#include "ui/window/locked.h"
#include "ui/window/order.h"
#include "ui/window/studies.h"

namespace ui
{

class RenderThread
{
  public:
    // `open` gives a device, to the thread itself and to the one that compiles ahead. `shaders`: a directory to watch
    // for changes, empty: none. `wake` is called from the thread whenever there is something new. Ends after the
    // current frame.
    RenderThread(std::function<gpu::Device()> open, const std::string& shaders, std::function<void()> wake);

    void order(const Order& order);

    ShotPointer shot(Side side) const { return copyOf(shots_[side], mutex_); } // the latest; null before the first
    std::shared_ptr<const SceneFacts> scene() const { return copyOf(sceneFacts_, mutex_); }
    std::shared_ptr<const Findings> findings() const { return copyOf(findings_, mutex_); } // of the studies; never null
    std::string activity() const; // what the order waits for, "Building the BVH: 40%"; empty: nothing
    // What is compiled for settings that nobody has asked for yet; empty: nothing.
    std::string ahead() const { return compiler_.activity(); }
    // Why the last order could not be followed, once; `back` becomes what goes on instead.
    std::optional<std::string> takeFailure(Order& back);

  private:
    void run(const std::stop_token& stop);
    void follow(const Order& order);
    void load(const Order& order);
    bool sameWorld(const Order& order) const;
    void pose(const Order& order);
    void begin(const passes::Playback& playback, uint64_t first);
    void bring(const passes::Playback& playback, uint64_t frame, uint64_t first);
    void advance(const Order& order);
    bool moves() const { return sides_[A]->renderer().scene().moves(); }
    void tune(const Order& order, Side side);
    void study(const Order& order);
    void compileAhead(const Order& order);
    void reloadShaders();
    void closeDevice();
    void renderAndPublish(const Order& order, bool changed);
    void publish(Side side, ShotPointer shot);
    void fail(const std::string& sentence);
    void say(const std::string& activity);

    std::function<gpu::Device()> open_;
    std::string shaderDirectory_;
    std::function<void()> wake_;

    mutable std::mutex mutex_; // of all up to compiler_
    std::condition_variable_any changed_;
    Order wanted_;
    bool news_ = false;
    bool pending_ = false; // a side goes on with its old settings until the new ones are compiled
    ShotPointer shots_[SIDES];
    std::shared_ptr<const SceneFacts> sceneFacts_;
    std::shared_ptr<const Findings> findings_ = std::make_shared<const Findings>();
    std::string activity_;
    std::optional<std::string> failure_;
    Order good_; // the last order that was followed
    CompileAhead compiler_;

    // The thread's own.
    std::optional<gpu::ShaderWatcher> watcher_;
    bool reload_ = false;
    std::unique_ptr<gpu::Device> device_;
    std::unique_ptr<scene::Scene> scene_;
    passes::Playback playback_; // of a scene that moves, since the sides have last started over
    uint64_t first_ = 0;        // frame of the timeline that they showed then
    uint64_t shown_ = 0;        // and now
    std::unique_ptr<Contender> sides_[SIDES];
    Studies studies_; // of the sides' scene and device
    Order running_;
    std::jthread thread_; // last: starts when all else is there
};

} // namespace ui
