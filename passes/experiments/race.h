#pragma once
// Methods side by side on one machine: in turns, in short slices of time, so that a busy machine treats all alike.

#include <functional>
#include <string>
#include <vector>

#include "engine/image/metrics.h"
#include "passes/experiments/reference.h"
#include "passes/renderer.h"
#include "passes/sequence.h"

namespace passes
{

// A method's error after some frames of one repeat. `error` lacks the reference's own (image::without).
struct Sample {
    uint32_t method = 0; // index
    bool average = true; // the mean of all frames, or the last one
    uint64_t frames = 0;
    double deviceSeconds = 0; // of this method's own frames, by the device's clock; 0 where it has none
    double wallSeconds = 0;   // of this method's own slices
    image::Metrics error;
};

struct Repeat {
    std::vector<Sample> samples;      // by time
    std::vector<image::Image> finals; // each method's last picture: the mean, or where something moves the last frame
    uint64_t nonFinite = 0;           // values counted in all stages of all methods
    bool complete = false;            // false: stopped before its end
};

// When to measure: after 1, 2, 3, 4, 6, 8, 12, 16... frames, or where something moves, so that each needs a reference
// of its own, after 1, 2, 4, 8...
bool isCheckpoint(uint64_t frames, bool moving);

class Race
{
  public:
    struct Limits {
        uint64_t frames = 0;       // of each method; 0: by time, where nothing moves
        double seconds = 0;        // of each method, wall
        double sliceSeconds = 0.1; // one turn
    };
    // One renderer for each method, all with one scene. Frames before the clock starts let the driver compile.
    Race(gpu::Device& device, const scene::Scene& scene, const std::vector<Settings>& methods, Sequence sequence,
         const Limits& limits, const std::function<void(double)>& bvhProgress = {});

    const Renderer& renderer() const { return *runners_.front().renderer; }
    Renderer& renderer() { return *runners_.front().renderer; }

    // All methods with the seed, in turns whose order rotates. `progress` gets the part done; when `stop` says so the
    // repeat ends as it is.
    Repeat run(uint64_t seed, References& references, const std::function<void(double)>& progress,
               const std::function<bool()>& stop);

  private:
    struct Runner {
        std::unique_ptr<Renderer> renderer;
        double wallSeconds = 0;
        bool done = false;
    };
    void prepare(uint64_t seed);
    bool slice(Runner& runner); // true when it is time to measure
    bool measure(uint32_t method, References& references, Repeat& repeat);
    double doneOf(const Runner& runner) const;

    Sequence sequence_;
    Limits limits_;
    std::vector<Runner> runners_;
};

} // namespace passes
