#include "passes/experiments/race_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace passes
{

namespace
{

constexpr double NONE = std::numeric_limits<double>::quiet_NaN();

} // namespace

RaceFigures::RaceFigures(std::span<const Repeat> repeats)
{
    for (const Repeat& repeat : repeats)
        if (repeat.complete) repeats_.push_back(&repeat);
    if (repeats_.empty())
        for (const Repeat& repeat : repeats)
            if (!repeat.samples.empty()) repeats_.push_back(&repeat);
    for (const Repeat* repeat : repeats_)
        for (const Sample& sample : repeat->samples) deviceClock_ &= sample.deviceSeconds > 0;
}

std::vector<const Sample*> RaceFigures::samples(size_t repeat, Lane lane) const
{
    std::vector<const Sample*> found;
    for (const Sample& sample : repeats_[repeat]->samples)
        if (sample.method == lane.method && sample.average == lane.average) found.push_back(&sample);
    return found;
}

statistics::ErrorCurve RaceFigures::curve(size_t repeat, Lane lane, Figure figure) const
{
    statistics::ErrorCurve curve;
    for (const Sample* sample : samples(repeat, lane)) {
        curve.seconds.push_back(seconds(*sample));
        curve.errors.push_back(sample->error.*figure);
    }
    return curve;
}

double RaceFigures::commonSeconds(std::span<const Lane> lanes) const
{
    double common = std::numeric_limits<double>::infinity();
    for (size_t r = 0; r < repeats(); ++r)
        for (const Lane lane : lanes) {
            const auto list = samples(r, lane);
            common = std::min(common, list.empty() ? 0 : seconds(*list.back()));
        }
    return std::isfinite(common) ? common : 0;
}

std::vector<uint64_t> RaceFigures::framesOf(Lane lane) const
{
    std::vector<uint64_t> common;
    for (size_t r = 0; r < repeats(); ++r) {
        std::vector<uint64_t> frames;
        for (const Sample* sample : samples(r, lane)) frames.push_back(sample->frames);
        if (r == 0) common = frames;
        std::erase_if(common, [&](uint64_t f) { return std::ranges::find(frames, f) == frames.end(); });
    }
    return common;
}

uint64_t RaceFigures::commonFrames(std::span<const Lane> lanes) const
{
    if (lanes.empty()) return 0;
    std::vector<uint64_t> common = framesOf(lanes.front());
    for (const Lane lane : lanes) {
        const std::vector<uint64_t> frames = framesOf(lane);
        std::erase_if(common, [&](uint64_t f) { return std::ranges::find(frames, f) == frames.end(); });
    }
    return common.empty() ? 0 : common.back();
}

std::vector<double> RaceFigures::at(Lane lane, Figure figure, double seconds) const
{
    std::vector<double> values;
    for (size_t r = 0; r < repeats(); ++r)
        values.push_back(statistics::errorAt(curve(r, lane, figure), seconds).value_or(NONE));
    return values;
}

std::vector<double> RaceFigures::linearAt(Lane lane, Figure figure, double seconds) const
{
    std::vector<double> values;
    for (size_t r = 0; r < repeats(); ++r) {
        statistics::ErrorCurve exponential = curve(r, lane, figure);
        for (double& value : exponential.errors) value = std::exp(value); // its logarithm is what is interpolated
        const std::optional<double> found = statistics::errorAt(exponential, seconds);
        values.push_back(found ? std::log(*found) : NONE);
    }
    return values;
}

std::vector<double> RaceFigures::after(Lane lane, Figure figure, uint64_t frames) const
{
    std::vector<double> values(repeats(), NONE);
    for (size_t r = 0; r < repeats(); ++r)
        for (const Sample* sample : samples(r, lane))
            if (sample->frames == frames) values[r] = sample->error.*figure;
    return values;
}

std::vector<double> RaceFigures::secondsAfter(Lane lane, uint64_t frames) const
{
    std::vector<double> values(repeats(), NONE);
    for (size_t r = 0; r < repeats(); ++r)
        for (const Sample* sample : samples(r, lane))
            if (sample->frames == frames) values[r] = seconds(*sample);
    return values;
}

std::vector<double> RaceFigures::inTimeOf(Lane other, Lane lane, Figure figure, uint64_t frames) const
{
    std::vector<double> values = after(lane, figure, frames);
    const std::vector<double> its = secondsAfter(other, frames), own = secondsAfter(lane, frames);
    for (size_t r = 0; r < values.size(); ++r) values[r] *= own[r] / its[r];
    return values;
}

std::vector<double> RaceFigures::timesTo(Lane lane, Figure figure, double error) const
{
    std::vector<double> values;
    for (size_t r = 0; r < repeats(); ++r)
        values.push_back(statistics::timeTo(curve(r, lane, figure), error).value_or(NONE));
    return values;
}

std::vector<double> RaceFigures::slopes(Lane lane, Figure figure) const
{
    std::vector<double> values;
    for (size_t r = 0; r < repeats(); ++r) values.push_back(statistics::slopeOf(curve(r, lane, figure)).value_or(NONE));
    return values;
}

bool allAboveZero(std::span<const double> values)
{
    return !values.empty() && std::ranges::all_of(values, [](double v) { return v > 0 && std::isfinite(v); });
}

double finiteMedian(std::span<const double> values)
{
    std::vector<double> numbers;
    for (const double value : values)
        if (std::isfinite(value)) numbers.push_back(value);
    return numbers.empty() ? NONE : statistics::median(std::move(numbers));
}

} // namespace passes
