#pragma once
// Compiles stages on a thread of its own, so that pictures go on meanwhile. A CPU driver compiles when a shader first
// runs, in its device's one queue: there, a device of its own runs each stage once, which leaves the result in the
// driver's cache.

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "engine/gpu/gpu.h"
#include "passes/frame_plan.h"

namespace ui
{

class CompileAhead
{
  public:
    using Stages = passes::StageList;

    // `open` opens the device of its own; `wake` is called from the thread when a wanted list is done.
    // Ends after the stage at hand.
    CompileAhead(std::function<gpu::Device()> open, std::function<void()> wake);

    // Compiles for this device from now on; null: for none. What was made for another is gone when this returns.
    void serve(gpu::Device* device);
    // Whether all of them are compiled; if not, they come next. Throws Error: one of them does not compile.
    bool ready(const Stages& stages);
    void handOver(passes::PipelinePool& pool); // what was made since the last time
    void learn(const Stages& stages);          // that they are compiled already
    // To be compiled when nothing is wanted; replaces what was put off before.
    void later(const Stages& stages);
    void forget();                // shaders have changed on disk
    std::string activity() const; // "Compiling temporal, 3 to go"; empty: nothing to do

  private:
    using Stage = Stages::value_type;
    struct Result {
        bool done = false;
        std::string failure;
    };
    static std::string keyOf(const Stage& stage);
    void run(const std::stop_token& stop);
    void runOnce(const Stage& stage);
    void stopWork(std::unique_lock<std::mutex>& lock);

    std::function<gpu::Device()> open_;
    std::function<void()> wake_;
    mutable std::mutex mutex_; // of all up to thread_, but own_
    std::condition_variable_any changed_;
    gpu::Device* device_ = nullptr;
    std::deque<Stage> wanted_, putOff_;
    std::map<std::string, Result> results_;
    std::vector<std::pair<Stage, gpu::ComputePipeline>> made_;
    std::string current_;            // what is being compiled
    std::optional<gpu::Device> own_; // the thread's
    std::jthread thread_;            // last: starts when all else is there
};

} // namespace ui
