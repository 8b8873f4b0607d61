#include "engine/base/statistics.h"

#include "engine/base/check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

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

// What has no finite value is infinite or not a number, as in arithmetic.
using namespace boost::math::policies;
using Quiet = policy<domain_error<ignore_error>, pole_error<ignore_error>, overflow_error<ignore_error>,
                     evaluation_error<ignore_error>>;
using NormalLaw = boost::math::normal_distribution<double, Quiet>;
using StudentLaw = boost::math::students_t_distribution<double, Quiet>;

} // namespace

double normalUpperTail(double z)
{
    return cdf(complement(NormalLaw(), z));
}

double normalQuantile(double p)
{
    return quantile(NormalLaw(), p);
}

double studentUpperTail(double t, double degreesOfFreedom)
{
    return cdf(complement(StudentLaw(degreesOfFreedom), t));
}

double studentQuantile(double p, double degreesOfFreedom)
{
    return quantile(StudentLaw(degreesOfFreedom), p);
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

} // namespace statistics
