#pragma once
// What the repeats of a race say: curves, errors at equal time and equal frames, times to an error, slopes, all kept
// per repeat, so that methods are compared within repeats.

#include <span>
#include <vector>

#include "engine/base/convergence.h"
#include "passes/experiments/race.h"

namespace passes
{

using Figure = double image::Metrics::*;
constexpr Figure RELMSE = &image::Metrics::relmse, MSE = &image::Metrics::mse, CHROMA_MSE = &image::Metrics::chromaMse,
                 LUMA_MSE = &image::Metrics::lumaMse, PSNR = &image::Metrics::psnr, SSIM = &image::Metrics::ssim,
                 FLIP = &image::Metrics::flip;

// What a line of a plot or table is about.
struct Lane {
    uint32_t method = 0;
    bool average = true;
};

class RaceFigures
{
  public:
    // Uses complete repeats, or where there is none what there is.
    explicit RaceFigures(std::span<const Repeat> repeats);

    size_t repeats() const { return repeats_.size(); }
    bool deviceClock() const { return deviceClock_; } // else wall time: the device has no clock
    double seconds(const Sample& sample) const { return deviceClock_ ? sample.deviceSeconds : sample.wallSeconds; }

    std::vector<const Sample*> samples(size_t repeat, Lane lane) const;
    statistics::ErrorCurve curve(size_t repeat, Lane lane, Figure figure) const;

    double commonSeconds(std::span<const Lane> lanes) const;  // that all lanes reach in all repeats; 0: none
    uint64_t commonFrames(std::span<const Lane> lanes) const; // the most that all lanes were measured after; 0: none
    std::vector<uint64_t> framesOf(Lane lane) const;          // measured after, in all repeats

    // One value per repeat; NaN where a repeat has none.
    std::vector<double> at(Lane lane, Figure figure, double seconds) const; // of errors: between points by logarithms
    std::vector<double> linearAt(Lane lane, Figure figure, double seconds) const; // of others: by log time only
    std::vector<double> after(Lane lane, Figure figure, uint64_t frames) const;
    std::vector<double> secondsAfter(Lane lane, uint64_t frames) const;
    // after(), had each frame as many samples a pixel as fit into the time of one of `other`.
    std::vector<double> inTimeOf(Lane other, Lane lane, Figure figure, uint64_t frames) const;
    std::vector<double> timesTo(Lane lane, Figure figure, double error) const;
    std::vector<double> slopes(Lane lane, Figure figure) const;

  private:
    std::vector<const Repeat*> repeats_;
    bool deviceClock_ = true;
};

bool allAboveZero(std::span<const double> values);   // and numbers: logarithms can be taken
double finiteMedian(std::span<const double> values); // of those that are numbers; NaN when none is

} // namespace passes
