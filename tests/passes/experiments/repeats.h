#pragma once
// Repeats of a race that nobody ran.

#include <cmath>
#include <limits>
#include <random>

#include "passes/experiments/race.h"

namespace support
{

constexpr uint64_t FRAMES[] = {1, 2, 4, 8, 16, 32};

// pt's error is 1/frames at 0.1 s a frame; the other one's `factor` as much at 0.2 s a frame.
inline passes::Repeat repeatOf(uint64_t seed, double factor, bool moving)
{
    std::mt19937_64 random(seed);
    std::normal_distribution<double> gaussian(0, 0.05);
    passes::Repeat repeat{.complete = true};
    for (const uint64_t frames : FRAMES)
        for (uint32_t method = 0; method < 2; ++method)
            for (const bool average : {true, false}) {
                if (moving && average) continue;
                passes::Sample s{.method = method, .average = average, .frames = frames};
                s.wallSeconds = s.deviceSeconds = double(frames) * (method == 0 ? 0.1 : 0.2);
                const double error = (method == 0 ? 1 : factor) / (average ? double(frames) : 1);
                s.error.mse = error * std::exp(gaussian(random));
                s.error.relmse = s.error.mse;
                s.error.lumaMse = s.error.chromaMse = s.error.mse / 2;
                s.error.psnr = -10 * std::log10(s.error.mse);
                s.error.ssim = 0.9;
                s.error.flip = std::numeric_limits<double>::quiet_NaN();
                repeat.samples.push_back(s);
            }
    return repeat;
}

} // namespace support
