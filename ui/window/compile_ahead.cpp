#include "ui/window/compile_ahead.h"

#include "engine/base/error.h"
#include "engine/base/memory.h"

#include <algorithm>
#include <chrono>
#include <unistd.h>

namespace ui
{

namespace
{

constexpr int BACKGROUND = 10; // nice: after the renderer, where both are on the CPU
// After these there is time to tidy up: soon, and once more what the renderer's own first runs have left by then.
constexpr std::chrono::seconds QUIET[] = {std::chrono::seconds(2), std::chrono::seconds(8)};
constexpr uint64_t BUFFER_BYTES = 1024; // larger than every uniform block

gpu::ComputePipelineDescriptor descriptorOf(const passes::StageList::value_type& stage)
{
    return {.label = stage.first, .constants = passes::constants(stage.second)};
}

} // namespace

CompileAhead::CompileAhead(std::function<gpu::Device()> open, std::function<void()> wake)
    : open_(std::move(open)), wake_(std::move(wake)), thread_([this](const std::stop_token& stop) { run(stop); })
{
}

std::string CompileAhead::keyOf(const Stage& stage)
{
    std::string key = stage.first;
    for (const gpu::Constant& constant : passes::constants(stage.second))
        key += fmt::format(" {}={}", constant.name, constant.value);
    return key;
}

// Waits for the stage at hand, which keeps device_ busy.
void CompileAhead::stopWork(std::unique_lock<std::mutex>& lock)
{
    wanted_.clear();
    putOff_.clear();
    changed_.wait(lock, [&] { return current_.empty(); });
    results_.clear();
    made_.clear();
}

void CompileAhead::serve(gpu::Device* device)
{
    std::unique_lock lock(mutex_);
    stopWork(lock);
    device_ = device;
}

void CompileAhead::forget()
{
    std::unique_lock lock(mutex_);
    stopWork(lock);
}

bool CompileAhead::ready(const Stages& stages)
{
    const std::lock_guard lock(mutex_);
    std::deque<Stage> missing;
    for (const Stage& stage : stages) {
        const Result& result = results_[keyOf(stage)];
        if (!result.failure.empty()) throw Error("{}", result.failure);
        if (!result.done) missing.push_back(stage);
    }
    if (missing.empty()) return true;
    wanted_ = std::move(missing);
    changed_.notify_all();
    return false;
}

void CompileAhead::handOver(passes::PipelinePool& pool)
{
    const std::lock_guard lock(mutex_);
    for (auto& [stage, pipeline] : made_) pool.put(stage.first, stage.second, std::move(pipeline));
    made_.clear();
}

void CompileAhead::learn(const Stages& stages)
{
    const std::lock_guard lock(mutex_);
    for (const Stage& stage : stages) results_[keyOf(stage)] = {.done = true};
}

void CompileAhead::later(const Stages& stages)
{
    const std::lock_guard lock(mutex_);
    putOff_.assign(stages.begin(), stages.end());
    changed_.notify_all();
}

std::string CompileAhead::activity() const
{
    const std::lock_guard lock(mutex_);
    if (current_.empty()) return "";
    const size_t left = wanted_.empty() ? putOff_.size() : wanted_.size();
    return fmt::format("Compiling {}, {} more to go", current_, left);
}

void CompileAhead::run(const std::stop_token& stop)
{
    [[maybe_unused]] const int niceness = nice(BACKGROUND); // of this thread, on Linux
    std::unique_lock lock(mutex_);
    const auto due = [&] { return device_ && (!wanted_.empty() || !putOff_.empty()); };
    while (true) {
        // Compilers of CPU drivers, here and wherever a new pipeline first ran, leave hundreds of MB behind.
        for (const std::chrono::seconds quiet : QUIET) {
            if (changed_.wait_for(lock, stop, quiet, due) || stop.stop_requested()) break;
            lock.unlock();
            memory::giveBackFreed();
            lock.lock();
        }
        changed_.wait(lock, stop, due);
        if (stop.stop_requested()) return;
        const bool urgent = !wanted_.empty();
        std::deque<Stage>& list = urgent ? wanted_ : putOff_;
        const Stage stage = std::move(list.front());
        list.pop_front();
        const std::string key = keyOf(stage);
        if (!results_[key].done && results_[key].failure.empty()) {
            current_ = stage.first;
            std::optional<gpu::ComputePipeline> pipeline;
            std::string failure;
            lock.unlock();
            try {
                if (device_->adapter().kind == "cpu") runOnce(stage);
                pipeline = device_->createComputePipeline(descriptorOf(stage));
            } catch (const Error& error) {
                failure = error.what();
            }
            lock.lock();
            results_[key] = {failure.empty(), failure};
            if (pipeline) made_.emplace_back(stage, std::move(*pipeline));
            current_.clear();
            changed_.notify_all();
        }
        if (urgent ? wanted_.empty() : putOff_.empty()) {
            lock.unlock();
            wake_();
            lock.lock();
        }
    }
}

// On a picture without pixels.
void CompileAhead::runOnce(const Stage& stage)
{
    if (!own_) own_ = open_();
    gpu::Device& device = *own_;
    const gpu::ComputePipeline pipeline = device.createComputePipeline(descriptorOf(stage));
    std::vector<gpu::Buffer> buffers;
    std::vector<std::vector<std::pair<std::string, size_t>>> sets;
    for (const gpu::Binding& binding : pipeline.bindings()) {
        buffers.push_back(
            device.createBuffer({.label = binding.name, .size = BUFFER_BYTES, .usage = gpu::usageFor(binding.kind)}));
        sets.resize(std::max<size_t>(sets.size(), binding.set + 1));
        sets[binding.set].emplace_back(binding.name, buffers.size() - 1);
    }
    std::vector<gpu::BindGroup> groups(sets.size());
    gpu::Dispatch dispatch{.pipeline = &pipeline, .groups = std::vector<const gpu::BindGroup*>(sets.size())};
    for (size_t set = 0; set < sets.size(); ++set) {
        if (sets[set].empty()) continue;
        gpu::BindGroupDescriptor descriptor{.label = stage.first, .pipeline = &pipeline, .set = uint32_t(set)};
        for (const auto& [name, index] : sets[set]) descriptor.buffers.emplace_back(name, &buffers[index]);
        groups[set] = device.createBindGroup(descriptor);
        dispatch.groups[set] = &groups[set];
    }
    gpu::CommandEncoder encoder = device.createCommandEncoder("compile ahead");
    encoder.dispatch(dispatch);
    device.queue().wait(device.queue().submit(std::move(encoder)));
}

} // namespace ui
