#pragma once
// Which way of estimating pays in a scene, from short measurements: `info --advise`.

#include <functional>
#include <string>
#include <vector>

#include "engine/base/convergence.h"
#include "passes/settings.h"

namespace gpu
{
class Device;
}
namespace scene
{
struct Scene;
}

namespace passes
{

struct Advice {
    struct Row {
        std::string method;      // in the words of --methods
        double milliseconds = 0; // of a frame, median of the repeats
        double error = 0;        // relative MSE of the last frame, likewise
        statistics::Factor gain; // how many times less error in the same time than the first row has
    };
    std::vector<Row> rows;          // one reservoir shown with its samples' colors, one with variate, one a channel
    double variance = 0;            // of a frame of the path tracer, radiance^2
    double plateau = 0;             // P of one reservoir: color noise that no history removes, radiance^2
    double treesPerPixel = 0;       // different path trees that the reservoirs of the channels hold
    uint32_t width = 0, height = 0; // pixels, as measured
    double degrees = 0;             // by which the camera turned in each frame

    size_t best() const; // the row to use: the cheapest of those that cannot be told from the one with most gain
    double crossover() const { return plateau > 0 ? variance / plateau : 0; } // M*, frames; 0: there is no plateau
};

// Measures with these settings (whose method, color and size it replaces), under a camera that turns. The scene rests.
// `progress` gets the part done. Throws Error when `stop` says so before the end, and where errors are too small.
Advice advise(gpu::Device& device, const scene::Scene& scene, const Settings& settings,
              const std::function<void(double)>& progress, const std::function<bool()>& stop);

// What that means, in sentences.
std::vector<std::string> sentencesOf(const Advice& advice, const Settings& settings);

} // namespace passes
