#include "engine/base/batches.h"

#include "engine/base/check.h"

namespace statistics
{

BatchValue combination(double a, const BatchValue& x, double b, const BatchValue& y)
{
    CHECK_EQ(x.without.size(), y.without.size());
    BatchValue result{.value = a * x.value + b * y.value};
    for (size_t run = 0; run < x.without.size(); ++run)
        result.without.push_back(a * x.without[run] + b * y.without[run]);
    return result;
}

Estimate combine(std::span<const BatchValue> batches)
{
    double total = 0;
    for (const BatchValue& batch : batches) total += double(batch.without.size()) - 1;
    Estimate result;
    for (const BatchValue& batch : batches) {
        Moments without;
        for (const double value : batch.without) without.add(value);
        const double n = double(batch.without.size());
        const double weight = (n - 1) / total;
        result.mean += weight * batch.value;
        result.varianceOfMean += weight * weight * without.variance() * (n - 1) * (n - 1) / n; // Tukey
        result.degreesOfFreedom += n - 1;
    }
    return result;
}

BatchValue meanCovariance(std::span<const float> x, std::span<const float> y, size_t runs)
{
    CHECK_LE(size_t{3}, runs);
    CHECK_EQ(x.size(), y.size());
    CHECK_EQ(x.size() % runs, size_t{0});
    const size_t series = x.size() / runs;
    const double n = double(runs);
    std::vector<double> meanX(series), meanY(series);
    for (size_t run = 0; run < runs; ++run)
        for (size_t s = 0; s < series; ++s) {
            meanX[s] += double(x[run * series + s]) / n;
            meanY[s] += double(y[run * series + s]) / n;
        }
    std::vector<double> products(runs);
    double sum = 0;
    for (size_t run = 0; run < runs; ++run) {
        for (size_t s = 0; s < series; ++s)
            products[run] += (double(x[run * series + s]) - meanX[s]) * (double(y[run * series + s]) - meanY[s]);
        products[run] /= double(series > 0 ? series : 1);
        sum += products[run];
    }
    BatchValue result{.value = sum / (n - 1)};
    // Without a run the means change too: of the co-moment goes n / (n - 1) times the run's product (Welford).
    for (const double product : products) result.without.push_back((sum - n / (n - 1) * product) / (n - 2));
    return result;
}

} // namespace statistics
