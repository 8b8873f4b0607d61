#include "engine/base/statistics.h"

#include "engine/base/check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace statistics
{

// ------------------------------------------------------------------------------------------------------------ moments
void Moments::add(double value)
{
    Moments one;
    one.count_ = 1;
    one.mean_ = value;
    merge(one);
}

void Moments::merge(const Moments& other)
{
    if (other.count_ == 0) return;
    if (count_ == 0) {
        *this = other;
        return;
    }
    const double a = static_cast<double>(count_);
    const double b = static_cast<double>(other.count_);
    const double n = a + b;
    const double d = other.mean_ - mean_;
    const double sum2 = sum2_ + other.sum2_ + d * d * a * b / n;
    const double sum3 =
        sum3_ + other.sum3_ + d * d * d * a * b * (a - b) / (n * n) + 3 * d * (a * other.sum2_ - b * sum2_) / n;
    const double sum4 = sum4_ + other.sum4_ + d * d * d * d * a * b * (a * a - a * b + b * b) / (n * n * n) +
                        6 * d * d * (a * a * other.sum2_ + b * b * sum2_) / (n * n) +
                        4 * d * (a * other.sum3_ - b * sum3_) / n;
    mean_ += d * b / n;
    sum2_ = sum2;
    sum3_ = sum3;
    sum4_ = sum4;
    count_ += other.count_;
}

double Moments::variance() const
{
    return count_ < 2 ? 0 : sum2_ / static_cast<double>(count_ - 1);
}

double Moments::varianceOfMean() const
{
    return count_ < 2 ? 0 : variance() / static_cast<double>(count_);
}

double Moments::excessKurtosis() const
{
    return sum2_ > 0 ? static_cast<double>(count_) * sum4_ / (sum2_ * sum2_) - 3 : 0;
}

double Moments::relativeErrorOfVariance() const
{
    if (count_ < 2) return std::numeric_limits<double>::infinity();
    if (sum2_ == 0) return 0;
    const double n = static_cast<double>(count_);
    return std::sqrt(std::max(0.0, excessKurtosis() / n + 2 / (n - 1)));
}

Estimate estimateOf(const Moments& moments)
{
    CHECK_LE(uint64_t{2}, moments.count());
    return {moments.mean(), moments.varianceOfMean(), static_cast<double>(moments.count() - 1)};
}

// ------------------------------------------------------------------------------------------------- tail probabilities
namespace
{

// Modified Lentz evaluation of b0 + a1/(b1 + a2/(b2 + ...)); Numerical Recipes 5.2.
template <class Terms>
double continuedFraction(double b0, Terms&& terms)
{
    const double tiny = 1e-300;
    double f = b0 == 0 ? tiny : b0;
    double c = f, d = 0;
    for (int i = 1; i < 10000; ++i) {
        const auto [a, b] = terms(i);
        d = b + a * d;
        if (d == 0) d = tiny;
        c = b + a / c;
        if (c == 0) c = tiny;
        d = 1 / d;
        f *= c * d;
        if (std::abs(c * d - 1) < 1e-15) break;
    }
    return f;
}

// Q(a, x) = Gamma(a, x) / Gamma(a); Abramowitz & Stegun 6.5.29 and 6.5.31.
double incompleteGammaUpper(double a, double x)
{
    if (x <= 0) return 1;
    const double front = std::exp(-x + a * std::log(x) - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (int i = 1; i < 10000 && std::abs(term) > 1e-16 * sum; ++i) {
            term *= x / (a + i);
            sum += term;
        }
        return 1 - sum * front;
    }
    const double fraction =
        continuedFraction(x + 1 - a, [&](int i) { return std::pair(-i * (i - a), x + 2 * i + 1 - a); });
    return front / fraction;
}

// I_x(a, b); Abramowitz & Stegun 26.5.8.
double incompleteBeta(double a, double b, double x)
{
    if (x <= 0) return 0;
    if (x >= 1) return 1;
    if (x > (a + 1) / (a + b + 2)) return 1 - incompleteBeta(b, a, 1 - x);
    const double front =
        std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x)) / a;
    const double fraction = continuedFraction(1, [&](int i) {
        const int m = i / 2;
        const double numerator = i % 2 == 0 ? m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
                                            : -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        return std::pair(numerator, 1.0);
    });
    return front / fraction;
}

// Root of a falling function.
template <class Function>
double bisect(double low, double high, Function&& falling)
{
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (falling(middle) > 0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

} // namespace

double normalUpperTail(double z)
{
    return 0.5 * std::erfc(z / std::numbers::sqrt2);
}

double normalQuantile(double p)
{
    if (p < 0.5) return -bisect(0, 40, [&](double z) { return normalUpperTail(z) - p; });
    return bisect(0, 40, [&](double z) { return normalUpperTail(z) - (1 - p); });
}

double studentUpperTail(double t, double degreesOfFreedom)
{
    // From here on it is normal within 1e-6 of the tail, and the gamma functions below lose their digits.
    constexpr double MANY_DEGREES = 1e8;
    if (degreesOfFreedom > MANY_DEGREES) return normalUpperTail(t);
    if (std::isinf(t)) return t > 0 ? 0 : 1;
    const double tail = 0.5 * incompleteBeta(degreesOfFreedom / 2, 0.5, degreesOfFreedom / (degreesOfFreedom + t * t));
    return t >= 0 ? tail : 1 - tail;
}

double studentQuantile(double p, double degreesOfFreedom)
{
    if (p < 0.5) return -studentQuantile(1 - p, degreesOfFreedom);
    return bisect(0, 1e6, [&](double t) { return studentUpperTail(t, degreesOfFreedom) - (1 - p); });
}

double chiSquaredUpperTail(double x, double degreesOfFreedom)
{
    return incompleteGammaUpper(degreesOfFreedom / 2, x / 2);
}

Interval meanInterval(const Estimate& estimate, double level)
{
    constexpr double INF = std::numeric_limits<double>::infinity();
    if (!(estimate.degreesOfFreedom > 0)) return {-INF, INF};
    const double half =
        studentQuantile((1 + level) / 2, estimate.degreesOfFreedom) * std::sqrt(estimate.varianceOfMean);
    return {estimate.mean - half, estimate.mean + half};
}

double sidakLevel(double family, uint64_t tests)
{
    return -std::expm1(std::log1p(-family) / static_cast<double>(tests));
}

// -------------------------------------------------------------------------------------------------------------- tests
Difference compare(const Estimate& a, const Estimate& b, double relativeRounding)
{
    const double rounding = relativeRounding * std::max(std::abs(a.mean), std::abs(b.mean));
    const double variance = a.varianceOfMean + b.varianceOfMean;
    Difference result;
    result.difference = a.mean - b.mean;
    result.standardError = std::sqrt(variance + rounding * rounding);
    // Welch, Satterthwaite.
    const double spread = a.varianceOfMean * a.varianceOfMean / a.degreesOfFreedom +
                          b.varianceOfMean * b.varianceOfMean / b.degreesOfFreedom;
    result.degreesOfFreedom =
        variance > 0 && spread > 0 ? variance * variance / spread : std::numeric_limits<double>::infinity();
    if (result.difference == 0) return result;
    const double t = std::abs(result.difference) / result.standardError; // infinite when both are exact and differ
    result.p = 2 * studentUpperTail(t, result.degreesOfFreedom);
    return result;
}

bool showsEquivalence(const Difference& difference, double margin, double level)
{
    const double reach = studentQuantile(1 - level, difference.degreesOfFreedom) * difference.standardError;
    return std::abs(difference.difference) + reach < margin;
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

Jackknife jackknife(std::span<const double> samples, const std::function<double(std::span<const double>)>& statistic)
{
    CHECK_LE(size_t{2}, samples.size());
    const double n = static_cast<double>(samples.size());
    std::vector<double> rest(samples.begin() + 1, samples.end());
    Moments leaveOneOut;
    for (size_t i = 0;; ++i) { // rest lacks sample i
        leaveOneOut.add(statistic(rest));
        if (i == rest.size()) break;
        rest[i] = samples[i];
    }
    Jackknife result;
    result.value = n * statistic(samples) - (n - 1) * leaveOneOut.mean();
    result.standardError = std::sqrt(leaveOneOut.variance() * (n - 1) * (n - 1) / n);
    return result;
}

} // namespace statistics
