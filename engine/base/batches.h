#pragma once
// Statistics of independent runs that are measured in batches, with intervals by the jackknife: leave one run out.

#include <cstddef>
#include <span>
#include <vector>

#include "engine/base/statistics.h"

namespace statistics
{

// A statistic of one batch: of all its runs, and of all but each one.
struct BatchValue {
    double value = 0;
    std::vector<double> without; // [run]

    bool operator==(const BatchValue&) const = default;
};

// a x + b y, run by run. The batches are of the same runs.
BatchValue combination(double a, const BatchValue& x, double b, const BatchValue& y);

// Batches as one estimate. A batch of n runs counts n - 1 times, as a covariance within the batch has n - 1 degrees of
// freedom. In the order given, so that equal batches give equal bits. No batch: an estimate of which nothing is known.
Estimate combine(std::span<const BatchValue> batches);

// The sample covariance over runs (1 / (n - 1), each series about its own means), averaged over the series. `x` and `y`
// hold the series of one run after those of another: [run * series + s]. At least three runs. In double precision and
// about the means, so nothing cancels.
BatchValue meanCovariance(std::span<const float> x, std::span<const float> y, size_t runs);

} // namespace statistics
