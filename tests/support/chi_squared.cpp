#include "tests/support/chi_squared.h"

#include "engine/base/check.h"

#include <cmath>
#include <vector>

#include <boost/math/distributions/chi_squared.hpp>

namespace statistics
{

double chiSquaredUpperTail(double x, double degreesOfFreedom)
{
    return cdf(complement(boost::math::chi_squared(degreesOfFreedom), x));
}

ChiSquared chiSquaredTest(std::span<const double> observed, std::span<const double> expected, double minimumExpected)
{
    CHECK_EQ(observed.size(), expected.size());
    struct Bin {
        double observed = 0, expected = 0;
    };
    std::vector<Bin> bins;
    Bin open, total;
    for (size_t i = 0; i < observed.size(); ++i) {
        open.observed += observed[i];
        open.expected += expected[i];
        total.observed += observed[i];
        total.expected += expected[i];
        if (open.expected < minimumExpected) continue;
        bins.push_back(open);
        open = {};
    }
    CHECK_LE(uint64_t{2}, bins.size());
    bins.back().observed += open.observed;
    bins.back().expected += open.expected;
    CHECK_LE(std::abs(total.observed - total.expected), 1e-3 * std::sqrt(total.observed) + 1e-6 * total.observed);

    ChiSquared result;
    for (const Bin& bin : bins) {
        const double d = bin.observed - bin.expected;
        result.statistic += d * d / bin.expected;
    }
    result.degreesOfFreedom = bins.size() - 1;
    result.p = chiSquaredUpperTail(result.statistic, static_cast<double>(result.degreesOfFreedom));
    return result;
}

} // namespace statistics
