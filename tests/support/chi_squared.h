#pragma once
// Are these counts those of that distribution?

#include <cstdint>
#include <span>

namespace statistics
{

double chiSquaredUpperTail(double x, double degreesOfFreedom); // P(X > x)

// Pearson's test that `observed` counts come from `expected` ones. Neighboring bins are pooled until each holds at
// least `minimumExpected`. The totals must agree within rounding: compare equal sample counts.
struct ChiSquared {
    double statistic = 0;
    uint64_t degreesOfFreedom = 0;
    double p = 1;
};
ChiSquared chiSquaredTest(std::span<const double> observed, std::span<const double> expected,
                          double minimumExpected = 5);

} // namespace statistics
