#include "engine/base/batches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace statistics
{
namespace
{

// Stationary AR(1) chains x' = a x + noise with variance 1: the covariance of successive values is a. A mean that
// differs from series to series and dwarfs the noise must not matter.
constexpr double A = 0.8;
struct Chains {
    std::vector<float> before, now; // [run * series + s]
};
Chains autoregressive(std::mt19937_64& random, size_t runs, size_t series)
{
    std::normal_distribution<double> normal;
    Chains chains;
    for (size_t run = 0; run < runs; ++run)
        for (size_t s = 0; s < series; ++s) {
            double x = normal(random);
            for (int step = 0; step < 3; ++step) x = A * x + std::sqrt(1 - A * A) * normal(random);
            const double next = A * x + std::sqrt(1 - A * A) * normal(random);
            const double mean = 1000 * double(s);
            chains.before.push_back(float(mean + x));
            chains.now.push_back(float(mean + next));
        }
    return chains;
}

TEST(MeanCovariance, LeavesOutEachRunAsIfItHadNotBeen)
{
    std::mt19937_64 random(3);
    constexpr size_t RUNS = 6, SERIES = 5;
    const Chains chains = autoregressive(random, RUNS, SERIES);
    const BatchValue all = meanCovariance(chains.before, chains.now, RUNS);
    ASSERT_EQ(all.without.size(), RUNS);
    for (size_t left = 0; left < RUNS; ++left) {
        Chains rest;
        for (size_t i = 0; i < chains.now.size(); ++i) {
            if (i / SERIES == left) continue;
            rest.before.push_back(chains.before[i]);
            rest.now.push_back(chains.now[i]);
        }
        EXPECT_NEAR(all.without[left], meanCovariance(rest.before, rest.now, RUNS - 1).value, 1e-12);
    }
}

// The textbook: sum over runs of (x - mean x)(y - mean y) / (n - 1).
TEST(MeanCovariance, IsTheMeanOfSampleCovariances)
{
    const std::vector<float> x = {1, 10, 2, 20, 6, 30}, y = {2, 5, 2, 5, 5, 2}; // two series, three runs
    // Series 0: means 3, 3: (-2)(-1) + (-1)(-1) + 3 * 2 = 9, / 2. Series 1: means 20, 4: -10 + 0 - 20 = -30, / 2.
    EXPECT_DOUBLE_EQ(meanCovariance(x, y, 3).value, (4.5 - 15) / 2);
}

// The whole way from chains to an interval, as `correlate` goes it: batches of unequal size, 1000 trials.
TEST(Combine, CoversTheTruthAsOftenAsItSays)
{
    constexpr int TRIALS = 1000;
    std::mt19937_64 random(4);
    int held = 0;
    Moments values;
    for (int trial = 0; trial < TRIALS; ++trial) {
        std::vector<BatchValue> batches;
        for (const size_t runs : {8u, 8u, 5u}) {
            const Chains chains = autoregressive(random, runs, 10);
            batches.push_back(meanCovariance(chains.before, chains.now, runs));
        }
        const Estimate estimate = combine(batches);
        EXPECT_EQ(estimate.degreesOfFreedom, 18);
        values.add(estimate.mean);
        const Interval interval = meanInterval(estimate);
        held += interval.low <= A && A <= interval.high;
    }
    EXPECT_GE(held, 930);
    EXPECT_LE(held, 970);
    EXPECT_NEAR(values.mean(), A, 4 * std::sqrt(values.varianceOfMean()));
    RecordProperty("held", held);
}

TEST(Combine, WeighsByDegreesOfFreedom)
{
    const std::vector<BatchValue> batches = {{.value = 1, .without = {1, 1, 1}},
                                             {.value = 4, .without = {4, 4, 4, 4, 4}}};
    const Estimate estimate = combine(batches);
    EXPECT_DOUBLE_EQ(estimate.mean, (2 * 1 + 4 * 4) / 6.0);
    EXPECT_EQ(estimate.varianceOfMean, 0);
    EXPECT_EQ(combine({}).degreesOfFreedom, 0);
    const BatchValue sum = combination(2, batches[0], -1, batches[0]);
    EXPECT_EQ(sum, batches[0]);
}

} // namespace
} // namespace statistics
