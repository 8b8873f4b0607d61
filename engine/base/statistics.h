#pragma once
// The arithmetic of measurements: moments, tail probabilities, intervals, t tests.

#include <cstdint>
#include <span>

namespace statistics
{

// Streaming mean and central moments up to the fourth (Welford 1962; merging: Chan et al. 1979, Pebay 2008).
class Moments
{
  public:
    void add(double value);
    void merge(const Moments& other);

    uint64_t count() const { return count_; }
    double mean() const { return mean_; }
    double variance() const;       // of one value, unbiased; 0 below two values
    double varianceOfMean() const; // of mean()
    double excessKurtosis() const; // 0 for a Gaussian; 0 when all values are equal

    // Relative standard deviation of variance(): sqrt((excess kurtosis) / n + 2 / (n - 1)). Heavy tails make it large:
    // a z-test on these moments is to be trusted when it is small (we ask for 10%).
    double relativeErrorOfVariance() const;

  private:
    uint64_t count_ = 0;
    double mean_ = 0;
    double sum2_ = 0, sum3_ = 0, sum4_ = 0; // sums of powers of deviations from the mean
};

// A measured mean, how well it is known, and from how much its variance was estimated.
struct Estimate {
    double mean = 0;
    double varianceOfMean = 0;
    double degreesOfFreedom = 0; // of varianceOfMean; infinity: it is known exactly
};
Estimate estimateOf(const Moments& moments);

double normalUpperTail(double z);                           // P(Z > z)
double normalQuantile(double p);                            // z with P(Z < z) = p
double studentUpperTail(double t, double degreesOfFreedom); // P(T > t); infinite degrees: normal
double studentQuantile(double p, double degreesOfFreedom);  // t with P(T < t) = p

// Where the mean of a distribution lies, after independent values of it, with probability `level` (Student's t; exact
// for Gaussian values). One value tells nothing: from -infinity to infinity.
struct Interval {
    double low = 0;
    double high = 0;
};
Interval meanInterval(const Estimate& estimate, double level = 0.95);

// Level of each of `tests` independent tests such that any of them rejects a true hypothesis with probability `family`.
double sidakLevel(double family, uint64_t tests);

// Welch's two-sample t: difference of means over its standard error. The sum of both variances also holds the square of
// `relativeRounding` times the larger mean: two exact results that differ by rounding agree.
struct Difference {
    double difference = 0;
    double standardError = 0;
    double degreesOfFreedom = 0;
    double p = 1; // two-sided
};
Difference compare(const Estimate& a, const Estimate& b, double relativeRounding = 0);

} // namespace statistics
