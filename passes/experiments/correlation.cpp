#include "passes/experiments/correlation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <tuple>

#include <fmt/format.h>

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
    std::vector<statistics::BatchValue> autocovariances, variances, films;
    std::map<uint32_t, std::vector<statistics::BatchValue>> lags;
    for (const CorrelationBatch& batch : batches) {
        if (batch.method != method) continue;
        for (const ChainPoint& own : batch.points) {
            if (own.frame != frame) continue;
            autocovariances.push_back(own.autocovariance);
            variances.push_back(own.variance);
            if (own.film) films.push_back(*own.film);
            for (const LagPoint& lag : own.lags) lags[lag.lag].push_back(lag.autocovariance);
            point.pixels += own.pixels;
            point.runs += batch.runs;
        }
    }
    if (point.runs > 0) point.pixels /= autocovariances.size();
    point.autocovariance = statistics::combine(autocovariances);
    point.variance = statistics::combine(variances);
    if (!films.empty()) point.film = statistics::combine(films);
    for (const auto& [lag, values] : lags) point.lags.push_back({lag, statistics::combine(values), std::nullopt});
    return point;
}

// What the law says of frames further apart, and of their mean, where it is known.
void predictFurther(CurvePoint& point, const Batches& own, const Settings& settings)
{
    const Color color = accumulates(settings) ? Color::Chosen : settings.color; // P is 0: all one
    for (LagEstimate& lag : point.lags)
        lag.law =
            laws(own, [&](const FrameLaw& law) { return predictedAutocovariance(law, color, point.frame, lag.lag); });
    if (point.film && color == Color::Chosen)
        point.filmLaw = laws(own, [&](const FrameLaw& law) { return predictedFilm(law, point.frame); });
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
            if (!own.empty() && known) predictFurther(point, own, method.settings);
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
    std::vector<std::string> columns = {"scene",    "method",         "shift",          "max_confidence",  "runs",
                                        "pixels",   "autocovariance", "ci_low",         "ci_high",         "predicted",
                                        "sigma2",   "plateau",        "standard_error", "predicted_error", "z",
                                        "variance", "film",           "film_predicted"};
    for (uint32_t lag = 2; lag <= MAX_LAG; lag *= 2)
        for (const char* name : {"lag_{}", "lag_{}_error", "lag_{}_predicted"})
            columns.push_back(fmt::format(fmt::runtime(name), lag));
    Csv csv(columns);
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
            std::vector<std::string> row = {correlation.scene,
                                            curve.method.name,
                                            shift,
                                            std::to_string(point.frame),
                                            std::to_string(point.runs),
                                            std::to_string(point.pixels),
                                            number(point.autocovariance.mean),
                                            number(interval.low),
                                            number(interval.high),
                                            meanOf(point.law),
                                            meanOf(correlation.sigma2),
                                            meanOf(curve.plateau),
                                            number(std::sqrt(point.autocovariance.varianceOfMean)),
                                            csvNumber(point.law ? std::sqrt(point.law->varianceOfMean) : NO_VALUE),
                                            csvNumber(point.z()),
                                            number(point.variance.mean),
                                            meanOf(point.film),
                                            meanOf(point.filmLaw)};
            for (uint32_t lag = 2; lag <= MAX_LAG; lag *= 2) {
                const auto own = std::ranges::find(point.lags, lag, &LagEstimate::lag);
                const bool known = own != point.lags.end();
                row.push_back(csvNumber(known ? own->autocovariance.mean : NO_VALUE));
                row.push_back(csvNumber(known ? std::sqrt(own->autocovariance.varianceOfMean) : NO_VALUE));
                row.push_back(known ? meanOf(own->law) : csvNumber(NO_VALUE));
            }
            csv.row(row);
        }
    }
    return csv.text();
}

} // namespace passes
