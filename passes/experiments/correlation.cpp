#include "passes/experiments/correlation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>

#include "engine/base/csv.h"

namespace passes
{

namespace
{

constexpr double NO_VALUE = std::numeric_limits<double>::quiet_NaN();

using Batches = std::vector<CorrelationBatch>;

statistics::Estimate laws(const Batches& batches, const std::function<statistics::BatchValue(const FrameLaw&)>& of)
{
    std::vector<statistics::BatchValue> values;
    for (const CorrelationBatch& batch : batches) values.push_back(of(*batch.law));
    return statistics::combine(values);
}

Batches withLaw(const Batches& batches, const std::string& method)
{
    Batches list;
    for (const CorrelationBatch& batch : batches)
        if (batch.method == method && batch.law) list.push_back(batch);
    return list;
}

std::vector<glm::dvec3> meanOver(const Batches& batches, std::vector<glm::dvec3> FrameLaw::*field)
{
    std::vector<glm::dvec3> mean(((*batches.front().law).*field).size());
    uint32_t runs = 0;
    for (const CorrelationBatch& batch : batches) {
        runs += batch.runs;
        for (size_t p = 0; p < mean.size(); ++p) mean[p] += double(batch.runs) * ((*batch.law).*field)[p];
    }
    for (glm::dvec3& value : mean) value /= double(runs);
    return mean;
}

// 2, 4, 8, ..., and `last` itself.
std::vector<uint32_t> framesUpTo(uint32_t last)
{
    std::vector<uint32_t> frames;
    for (uint64_t frame = 2; frame <= last; frame *= 2) frames.push_back(uint32_t(frame));
    if (last > 2 && frames.back() != last) frames.push_back(last);
    return frames;
}

CurvePoint pointAt(uint32_t frame, const Batches& batches, const std::string& method)
{
    CurvePoint point{.frame = frame};
    std::vector<statistics::BatchValue> autocovariances, variances;
    for (const CorrelationBatch& batch : batches) {
        if (batch.method != method) continue;
        for (const ChainPoint& own : batch.points) {
            if (own.frame != frame) continue;
            autocovariances.push_back(own.autocovariance);
            variances.push_back(own.variance);
            point.pixels += own.pixels;
            point.runs += batch.runs;
        }
    }
    if (point.runs > 0) point.pixels /= autocovariances.size();
    point.autocovariance = statistics::combine(autocovariances);
    point.variance = statistics::combine(variances);
    return point;
}

} // namespace

double CurvePoint::z() const
{
    if (runs == 0 || !law) return NO_VALUE;
    const statistics::Difference difference = statistics::compare(autocovariance, *law);
    return difference.standardError > 0 ? difference.difference / difference.standardError : NO_VALUE;
}

void evaluate(Correlation& correlation, const std::vector<NamedMethod>& methods, Batches batches)
{
    const auto key = [](const CorrelationBatch& batch) { return std::tie(batch.index, batch.method); };
    std::ranges::stable_sort(batches, {}, key);
    const auto equal = [&](const CorrelationBatch& a, const CorrelationBatch& b) { return key(a) == key(b); };
    batches.erase(std::unique(batches.begin(), batches.end(), equal), batches.end());

    for (const CorrelationBatch& batch : batches) correlation.nonFinite += batch.nonFinite;
    const Batches plain = withLaw(batches, PATH_TRACER);
    if (!plain.empty()) correlation.sigma2 = laws(plain, [](const FrameLaw& law) { return law.variance; });
    for (const NamedMethod& method : methods) {
        Curve curve{.method = method};
        const bool known = lawHolds(method.settings, correlation.sameView);
        const Batches own = accumulates(method.settings) ? plain : withLaw(batches, method.name);
        if (!own.empty() && known) {
            curve.plateau = laws(own, [](const FrameLaw& law) { return law.plateau; });
            curve.floor = meanOver(own, &FrameLaw::floor);
            curve.mean = meanOver(own, &FrameLaw::mean);
        }
        for (const uint32_t frame : framesUpTo(method.settings.maxConfidence)) {
            CurvePoint point = pointAt(frame, batches, method.name);
            const Color color = method.settings.color;
            const Batches& single = frame == 2 && color == Color::Weighted ? plain : own;
            if (!single.empty() && known)
                point.law =
                    laws(single, [&](const FrameLaw& law) { return predictedAutocovariance(law, color, frame); });
            if (point.runs > 0 || point.law) curve.points.push_back(point);
        }
        correlation.curves.push_back(std::move(curve));
    }
}

std::optional<statistics::Interval> crossover(const Correlation& correlation, const Curve& curve)
{
    if (!correlation.sigma2 || !curve.plateau) return std::nullopt;
    if (!(statistics::meanInterval(*curve.plateau).low > 0)) return std::nullopt;
    const statistics::Estimate &s = *correlation.sigma2, &p = *curve.plateau;
    const double value = s.mean / p.mean; // to first order, in logarithms, so that it stays above 0
    const double spread = std::sqrt(s.varianceOfMean / (s.mean * s.mean) + p.varianceOfMean / (p.mean * p.mean));
    const double factor = std::exp(statistics::studentQuantile(0.975, s.degreesOfFreedom) * spread);
    return statistics::Interval{value / factor, value * factor};
}

std::string csvOf(const Correlation& correlation)
{
    Csv csv({"scene", "method", "shift", "max_confidence", "runs", "pixels", "autocovariance", "ci_low", "ci_high",
             "predicted", "sigma2", "plateau", "standard_error", "predicted_error", "z", "variance"});
    for (const Curve& curve : correlation.curves) {
        std::string shift;
        for (const auto& [name, value] : toText(curve.method.settings))
            if (name == "shift") shift = value;
        const auto meanOf = [](const std::optional<statistics::Estimate>& e) {
            return csvNumber(e ? e->mean : NO_VALUE);
        };
        for (const CurvePoint& point : curve.points) {
            const bool measured = point.runs > 0;
            const statistics::Interval interval = statistics::meanInterval(point.autocovariance);
            const auto number = [&](double value) { return csvNumber(measured ? value : NO_VALUE); };
            csv.row({correlation.scene, curve.method.name, shift, std::to_string(point.frame),
                     std::to_string(point.runs), std::to_string(point.pixels), number(point.autocovariance.mean),
                     number(interval.low), number(interval.high), meanOf(point.law), meanOf(correlation.sigma2),
                     meanOf(curve.plateau), number(std::sqrt(point.autocovariance.varianceOfMean)),
                     csvNumber(point.law ? std::sqrt(point.law->varianceOfMean) : NO_VALUE), csvNumber(point.z()),
                     number(point.variance.mean)});
        }
    }
    return csv.text();
}

} // namespace passes
