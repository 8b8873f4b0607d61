#include "engine/base/statistics.h"
#include "tests/support/chi_squared.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace statistics
{
namespace
{

constexpr double INF = std::numeric_limits<double>::infinity();

// P(|X - n p| that far) < 1e-6 on each side, by the normal approximation: how many rejections n tests at level p may
// show.
void expectRate(double count, double n, double p)
{
    EXPECT_NEAR(count / n, p, 4.9 * std::sqrt(p * (1 - p) / n));
}

TEST(Moments, EqualTheTextbookFormulasInAnyGrouping)
{
    std::mt19937_64 random(1);
    std::gamma_distribution<double> gamma(2.0, 3.0);
    std::vector<double> values(1000);
    for (double& v : values) v = 1e3 + gamma(random);

    Moments all, left, right;
    for (size_t i = 0; i < values.size(); ++i) {
        all.add(values[i]);
        (i < 137 ? left : right).add(values[i]);
    }
    left.merge(right);

    const double n = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double s2 = 0, s4 = 0;
    for (const double v : values) {
        s2 += std::pow(v - mean, 2);
        s4 += std::pow(v - mean, 4);
    }
    for (const Moments& m : {all, left}) {
        EXPECT_EQ(m.count(), values.size());
        EXPECT_NEAR(m.mean(), mean, 1e-9);
        EXPECT_NEAR(m.variance(), s2 / (n - 1), 1e-9 * s2 / n);
        EXPECT_NEAR(m.varianceOfMean(), s2 / (n - 1) / n, 1e-9 * s2 / n);
        EXPECT_NEAR(m.excessKurtosis(), n * s4 / (s2 * s2) - 3, 1e-9);
    }
}

TEST(Moments, SurviveALargeOffset)
{
    Moments m;
    for (int i = 0; i < 1'000'000; ++i) m.add(1e9 + (i % 2));
    EXPECT_NEAR(m.variance(), 0.25, 1e-5);
}

TEST(Moments, PredictTheErrorOfTheVariance)
{
    std::mt19937_64 random(2);
    std::exponential_distribution<double> exponential(1.0); // excess kurtosis 6
    Moments variances, predicted;
    for (int trial = 0; trial < 2000; ++trial) {
        Moments m;
        for (int i = 0; i < 2000; ++i) m.add(exponential(random));
        variances.add(m.variance());
        predicted.add(m.relativeErrorOfVariance());
    }
    EXPECT_NEAR(predicted.mean(), std::sqrt(variances.variance()) / variances.mean(), 0.005);
    EXPECT_NEAR(predicted.mean(), std::sqrt(8.0 / 2000), 0.005);
}

TEST(TailProbabilities, EqualPublishedValues)
{
    EXPECT_NEAR(normalUpperTail(1.959963984540054), 0.025, 1e-15);
    EXPECT_NEAR(normalUpperTail(6), 9.865876450376981e-10, 1e-20);
    EXPECT_NEAR(normalQuantile(0.975), 1.959963984540054, 1e-12);
    EXPECT_NEAR(normalQuantile(0.025), -1.959963984540054, 1e-12);
    EXPECT_NEAR(studentUpperTail(1, 1), 0.25, 1e-13); // Cauchy: 1/2 - atan(t)/pi
    EXPECT_NEAR(studentUpperTail(-1, 1), 0.75, 1e-13);
    EXPECT_NEAR(studentQuantile(0.975, 4), 2.776445105197793, 1e-10);
    EXPECT_NEAR(studentQuantile(0.9995, 10), 4.586893858702636, 1e-10);
    EXPECT_NEAR(studentUpperTail(3, 1e7), normalUpperTail(3), 1e-8);
    for (const double many : {1e8, 1e12, 1e19, 1e36, INF})
        EXPECT_NEAR(studentUpperTail(2, many) / normalUpperTail(2), 1, 1e-6) << many;
    EXPECT_NEAR(studentQuantile(0.95, 1e36), normalQuantile(0.95), 1e-9);
    EXPECT_NEAR(chiSquaredUpperTail(3, 2), std::exp(-1.5), 1e-14); // two degrees: exp(-x/2)
    EXPECT_NEAR(chiSquaredUpperTail(9, 1), 2 * normalUpperTail(3), 1e-14);
    EXPECT_NEAR(chiSquaredUpperTail(124.342113404004, 100), 0.05, 1e-12);
    double poisson = 0; // 2k degrees: P(Poisson(x / 2) < k)
    for (int k = 0; k < 50; ++k) poisson += std::exp(-30 + k * std::log(30.0) - std::lgamma(k + 1.0));
    EXPECT_NEAR(chiSquaredUpperTail(60, 100), poisson, 1e-12);
    EXPECT_NEAR(1 - std::pow(1 - sidakLevel(1e-3, 48), 48), 1e-3, 1e-12);
}

TEST(Compare, HasItsLevelWithFewRunsAndUnequalVariances)
{
    std::mt19937_64 random(3);
    std::normal_distribution<double> wide(5, 2), narrow(5, 0.5);
    const int trials = 20000;
    std::array<int, 2> rejected = {0, 0};
    const std::array<double, 2> levels = {0.05, 0.005};
    for (int trial = 0; trial < trials; ++trial) {
        Moments a, b;
        for (int i = 0; i < 6; ++i) a.add(wide(random));
        for (int i = 0; i < 20; ++i) b.add(narrow(random));
        const double p = compare(estimateOf(a), estimateOf(b)).p;
        for (size_t i = 0; i < levels.size(); ++i) rejected[i] += p < levels[i];
    }
    for (size_t i = 0; i < levels.size(); ++i) expectRate(rejected[i], trials, levels[i]);
}

TEST(Compare, TellsExactValuesApart)
{
    const Estimate one{1, 0, INF}, close{1 + 1e-7, 0, INF};
    EXPECT_EQ(compare(one, one).p, 1);
    EXPECT_EQ(compare(one, close).p, 0);
    EXPECT_GT(compare(one, close, 1e-6).p, 0.9);
    EXPECT_LT(compare(one, {1.00001, 0, INF}, 1e-6).p, 1e-9);
}

// Rejections among 200 chi-squared tests of draws from `truth` against the flat distribution.
int chiSquaredRejections(const std::vector<double>& truth, double level)
{
    std::mt19937_64 random(5);
    std::discrete_distribution<size_t> draw(truth.begin(), truth.end());
    const double n = 200'000;
    const std::vector<double> expected(truth.size(), n / static_cast<double>(truth.size()));
    int rejected = 0;
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<double> observed(truth.size(), 0.0);
        for (int i = 0; i < n; ++i) ++observed[draw(random)];
        rejected += chiSquaredTest(observed, expected).p < level;
    }
    return rejected;
}

TEST(ChiSquared, HasItsLevelAndRejectsAPlantedErrorOfTwoPercent)
{
    std::vector<double> truth(16, 1.0);
    expectRate(chiSquaredRejections(truth, 0.1), 200, 0.1);
    for (size_t i = 0; i < truth.size(); ++i) truth[i] *= i % 2 == 0 ? 1.02 : 0.98;
    EXPECT_GT(chiSquaredRejections(truth, 1e-3), 190);
}

TEST(ChiSquared, PoolsSmallBinsAndKeepsItsLevel)
{
    std::mt19937_64 random(6);
    std::vector<double> truth(200);
    for (size_t i = 0; i < truth.size(); ++i) truth[i] = std::exp(-0.2 * static_cast<double>(i));
    const double sum = std::accumulate(truth.begin(), truth.end(), 0.0);
    std::discrete_distribution<size_t> draw(truth.begin(), truth.end());
    const double n = 2000;
    for (double& t : truth) t *= n / sum;
    const int trials = 2000;
    int rejected = 0;
    for (int trial = 0; trial < trials; ++trial) {
        std::vector<double> observed(truth.size(), 0.0);
        for (int i = 0; i < n; ++i) ++observed[draw(random)];
        const ChiSquared test = chiSquaredTest(observed, truth);
        EXPECT_LT(test.degreesOfFreedom, 40u);
        rejected += test.p < 0.05;
    }
    expectRate(rejected, trials, 0.05);
}

TEST(MeanInterval, HoldsTheMeanAsOftenAsItSays)
{
    std::mt19937_64 random(7);
    std::normal_distribution<double> gauss(3.0, 2.0);
    constexpr int TRIALS = 5000;
    int held = 0;
    for (int trial = 0; trial < TRIALS; ++trial) {
        Moments moments;
        for (int i = 0; i < 5; ++i) moments.add(gauss(random));
        const Interval interval = meanInterval(estimateOf(moments));
        held += interval.low <= 3.0 && 3.0 <= interval.high;
    }
    expectRate(held, TRIALS, 0.95);

    EXPECT_EQ(meanInterval({.mean = 1}).low, -INF);
    EXPECT_EQ(meanInterval({.mean = 2, .varianceOfMean = 0, .degreesOfFreedom = INF}).high, 2);
}

} // namespace
} // namespace statistics
