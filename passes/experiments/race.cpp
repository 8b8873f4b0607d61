#include "passes/experiments/race.h"

#include "engine/base/check.h"
#include "engine/base/clock.h"

#include <algorithm>
#include <bit>

namespace passes
{

namespace
{

// Frames whose cameras make the stages of both a resting and a moving view compile.
constexpr uint64_t WARM_UP[] = {0, 0, 1, 64, 4096};

double deviceSecondsOf(const RenderStats& stats, uint64_t frames)
{
    double milliseconds = 0;
    for (const auto& [stage, perFrame] : stats.stageMilliseconds) milliseconds += perFrame;
    return milliseconds * double(frames) / 1000;
}

} // namespace

bool isCheckpoint(uint64_t frames, bool moving)
{
    return std::has_single_bit(frames) || (!moving && frames % 3 == 0 && std::has_single_bit(frames / 3));
}

Race::Race(gpu::Device& device, const scene::Scene& scene, const std::vector<Settings>& methods, Sequence sequence,
           const Limits& limits, const std::function<void(double)>& bvhProgress)
    : sequence_(std::move(sequence)), limits_(limits)
{
    CHECK(!methods.empty());
    CHECK(!sequence_.moves() || limits_.frames > 0); // each measured frame has a reference of its own, then
    for (const Settings& settings : methods)
        runners_.push_back({runners_.empty() ? std::make_unique<Renderer>(device, scene, settings,
                                                                          SceneOptions{.bvhProgress = bvhProgress,
                                                                                       .moves = sequence_.sceneMoves()})
                                             : std::make_unique<Renderer>(renderer(), settings)});
    for (Runner& runner : runners_) {
        for (const uint64_t frame : WARM_UP) {
            sequence_.bring(*runner.renderer, int64_t(frame));
            runner.renderer->renderFrame();
        }
    }
}

void Race::prepare(uint64_t seed)
{
    for (Runner& runner : runners_) {
        Settings settings = runner.renderer->settings();
        settings.seed = seed;
        runner.renderer->apply(settings);
        sequence_.bring(*runner.renderer, 0);
        runner.renderer->reset(); // afterwards: nothing must seem to have jumped there
        runner.wallSeconds = 0;
        runner.done = false;
    }
}

Repeat Race::run(uint64_t seed, References& references, const std::function<void(double)>& progress,
                 const std::function<bool()>& stop)
{
    prepare(seed);
    Repeat repeat;
    const auto finished = [&] { return std::ranges::all_of(runners_, &Runner::done); };
    for (size_t first = 0; !finished(); ++first) {
        for (size_t i = 0; i < runners_.size(); ++i) {
            const size_t method = (first + i) % runners_.size();
            Runner& runner = runners_[method];
            if (runner.done) continue;
            if (slice(runner) && !measure(uint32_t(method), references, repeat)) return repeat;
            double sum = 0;
            for (const Runner& each : runners_) sum += doneOf(each);
            progress(sum / double(runners_.size()));
            if (stop()) return repeat;
        }
    }
    for (Runner& runner : runners_) {
        repeat.finals.push_back(runner.renderer->read(sequence_.moves() ? LAST_FRAME : MEAN));
        repeat.nonFinite += sumOf(runner.renderer->stats().nonFinite);
    }
    repeat.complete = true;
    return repeat;
}

double Race::doneOf(const Runner& runner) const
{
    if (runner.done) return 1;
    return limits_.frames > 0 ? double(runner.renderer->frameCount()) / double(limits_.frames)
                              : std::min(runner.wallSeconds / limits_.seconds, 1.0);
}

bool Race::slice(Runner& runner)
{
    const auto start = Clock::now();
    Renderer& renderer = *runner.renderer;
    const auto atEnd = [&] { return limits_.frames > 0 && renderer.frameCount() >= limits_.frames; };
    bool checkpoint = false;
    do {
        sequence_.bring(renderer, int64_t(renderer.frameCount()));
        renderer.renderFrame();
        checkpoint = isCheckpoint(renderer.frameCount(), sequence_.moves());
    } while (!checkpoint && !atEnd() && secondsSince(start) < limits_.sliceSeconds);
    renderer.wait();
    runner.wallSeconds += secondsSince(start);
    runner.done = atEnd() || (limits_.frames == 0 && runner.wallSeconds >= limits_.seconds);
    return checkpoint || runner.done;
}

// False when there was no reference: stopped.
bool Race::measure(uint32_t method, References& references, Repeat& repeat)
{
    Runner& runner = runners_[method];
    Renderer& renderer = *runner.renderer;
    const uint64_t frames = renderer.frameCount();
    const Reference* reference = references.after(frames);
    if (reference == nullptr) return false;
    Sample sample{.method = method,
                  .frames = frames,
                  .deviceSeconds = deviceSecondsOf(renderer.stats(), frames),
                  .wallSeconds = runner.wallSeconds};
    const auto add = [&](bool average, const image::Image& picture) {
        sample.average = average;
        sample.error = image::without(reference->error, image::measure(reference->picture, picture));
        repeat.samples.push_back(sample);
    };
    if (!sequence_.moves()) add(true, renderer.read(MEAN));
    add(false, renderer.read(LAST_FRAME));
    return true;
}

} // namespace passes
