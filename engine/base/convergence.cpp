#include "engine/base/convergence.h"

#include "engine/base/check.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace statistics
{

namespace
{

constexpr double DECADE = 10;
constexpr double AT_THE_EDGE = 1 + 1e-9; // a time within rounding of the curve's end is its end

// What y is at x on the line through two points, all logarithms taken and given back.
double between(double x0, double y0, double x1, double y1, double x)
{
    if (x1 == x0) return y1;
    return std::exp(std::log(y0) + (std::log(y1) - std::log(y0)) * (std::log(x) - std::log(x0)) / std::log(x1 / x0));
}

std::string factorText(const Factor& factor)
{
    return fmt::format("{:.3g} times [{:.3g}, {:.3g}]", factor.value, factor.interval.low, factor.interval.high);
}

std::string joined(const std::vector<std::string>& parts)
{
    std::string text;
    for (size_t i = 0; i < parts.size(); ++i) text += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
    return text;
}

} // namespace

std::optional<double> errorAt(const ErrorCurve& curve, double seconds)
{
    CHECK_EQ(curve.seconds.size(), curve.errors.size());
    if (curve.seconds.empty() || seconds < curve.seconds.front() || seconds > curve.seconds.back() * AT_THE_EDGE)
        return std::nullopt;
    const auto next = std::ranges::lower_bound(curve.seconds, seconds);
    const size_t right = std::min(size_t(next - curve.seconds.begin()), curve.seconds.size() - 1);
    const size_t left = right > 0 && curve.seconds[right] > seconds ? right - 1 : right;
    if (!(curve.errors[left] > 0) || !(curve.errors[right] > 0)) return std::nullopt;
    return between(curve.seconds[left], curve.errors[left], curve.seconds[right], curve.errors[right],
                   std::min(seconds, curve.seconds[right]));
}

std::optional<double> timeTo(const ErrorCurve& curve, double error)
{
    CHECK_EQ(curve.seconds.size(), curve.errors.size());
    for (size_t i = 0; i < curve.errors.size(); ++i) {
        if (!(curve.errors[i] > 0)) return std::nullopt;
        if (curve.errors[i] > error) continue;
        if (i == 0 && curve.errors[i] < error) return std::nullopt;
        if (i == 0) return curve.seconds[0];
        return between(curve.errors[i - 1], curve.seconds[i - 1], curve.errors[i], curve.seconds[i], error);
    }
    return std::nullopt;
}

std::optional<double> slopeOf(const ErrorCurve& curve)
{
    CHECK_EQ(curve.seconds.size(), curve.errors.size());
    Moments x, y;
    std::vector<std::pair<double, double>> points;
    for (size_t i = 0; i < curve.seconds.size(); ++i) {
        if (curve.seconds[i] * DECADE * AT_THE_EDGE < curve.seconds.back()) continue;
        if (!(curve.errors[i] > 0)) return std::nullopt;
        points.emplace_back(std::log(curve.seconds[i]), std::log(curve.errors[i]));
        x.add(points.back().first);
        y.add(points.back().second);
    }
    if (points.size() < 3 || x.variance() == 0) return std::nullopt;
    double product = 0;
    for (const auto& [u, v] : points) product += (u - x.mean()) * (v - y.mean());
    return product / (x.variance() * double(points.size() - 1));
}

double median(std::vector<double> values)
{
    CHECK(!values.empty());
    std::ranges::sort(values);
    const size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

Factor factorOf(std::span<const double> values, double level)
{
    CHECK(!values.empty());
    Moments logs;
    for (const double value : values) logs.add(std::log(value));
    const Interval interval = meanInterval({logs.mean(), logs.varianceOfMean(), double(logs.count() - 1)}, level);
    return {std::exp(logs.mean()), {std::exp(interval.low), std::exp(interval.high)}};
}

Factor ratioOf(std::span<const double> a, std::span<const double> b, double level)
{
    CHECK_EQ(a.size(), b.size());
    std::vector<double> ratios;
    for (size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / b[i]);
    return factorOf(ratios, level);
}

Ranking rank(std::span<const Contender> contenders, double level)
{
    Ranking ranking;
    if (contenders.empty()) return ranking;
    std::vector<double> means;
    for (const Contender& contender : contenders) {
        CHECK_EQ(contender.errors.size(), contenders.front().errors.size());
        if (contender.errors.size() < 2 || std::ranges::any_of(contender.errors, [](double e) { return !(e > 0); }))
            return ranking;
        means.push_back(factorOf(contender.errors).value);
    }
    std::vector<size_t> order(contenders.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::ranges::stable_sort(order, {}, [&](size_t i) { return means[i]; });
    const std::vector<double>& best = contenders[order.front()].errors;
    // All pairs, since the data chose the winner.
    const double each = 1 - sidakLevel(1 - level, std::max<size_t>(contenders.size() * (contenders.size() - 1) / 2, 1));
    ranking.places.push_back({order.front(), {1, {1, 1}}});
    for (const size_t other : std::span(order).subspan(1)) {
        const Factor ratio = ratioOf(contenders[other].errors, best, each);
        ranking.places.push_back({other, ratio, ratio.interval.low > 1});
    }
    return ranking;
}

std::string verdict(std::span<const Contender> contenders, const std::string& error, const std::string& where,
                    double level)
{
    const Ranking ranking = rank(contenders, level);
    if (ranking.places.size() < 2)
        return fmt::format("{} nothing can be said about {}: that needs two methods, two repeats, and a reference that "
                           "is better than they are.",
                           where, error);
    const std::string& best = contenders[ranking.places.front().contender].name;
    std::vector<std::string> equals, losers;
    for (const Ranking::Place& place : std::span(ranking.places).subspan(1)) {
        const std::string& name = contenders[place.contender].name;
        if (place.toldApart)
            losers.push_back(fmt::format("{} less than {}", factorText(place.ratio), name));
        else
            equals.push_back(fmt::format("{} ({})", name, factorText(place.ratio)));
    }
    const std::string sure = fmt::format("(intervals at {:g}% for all together, paired over {} repeats)", 100 * level,
                                         contenders.front().errors.size());
    if (equals.empty()) return fmt::format("{} {} has the least {}: {} {}.", where, best, error, joined(losers), sure);
    const std::string tied =
        fmt::format("{} {} and {} cannot be told apart by their {}", where, best, joined(equals), error);
    if (losers.empty()) return fmt::format("{} {}.", tied, sure);
    return fmt::format("{}; {} has {} {}.", tied, best, joined(losers), sure);
}

} // namespace statistics
