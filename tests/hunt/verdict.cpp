#include "tests/hunt/verdict.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace hunt
{

using statistics::Estimate;

namespace
{

Estimate estimateOf(const std::vector<double>& values)
{
    statistics::Moments moments;
    for (const double value : values) moments.add(value);
    return statistics::estimateOf(moments);
}

// The mean without what stands out above the values that are met `share` of the time or more.
Estimate winsorized(std::vector<double> values, double share)
{
    const size_t rare = std::min(size_t(std::ceil(share * double(values.size()))), values.size() - 1);
    if (rare == 0) return estimateOf(values);
    std::ranges::nth_element(values, values.end() - std::ptrdiff_t(rare) - 1);
    const double highest = values[values.size() - rare - 1];
    for (double& value : values) value = std::min(value, highest);
    return estimateOf(values);
}

// What is likely to be missing from the mean: see UNSEEN_TAIL. Of the largest values the one that says most counts.
double unseenTail(std::vector<double> values, double mean)
{
    const size_t looked = std::min<size_t>(values.size(), 4);
    std::ranges::partial_sort(values, values.begin() + std::ptrdiff_t(looked), std::greater());
    double most = 0;
    for (size_t k = 0; k < looked; ++k) most = std::max(most, double(k + 1) * (values[k] - mean));
    return values.empty() ? 0 : UNSEEN_TAIL * most / double(values.size());
}

} // namespace

void Values::finish(double chancesEach, double reachOfEach)
{
    estimate = estimateOf(values);
    chances = chancesEach * double(values.size());
    reach = reachOfEach;
}

Comparison compare(const Estimate& a, const Estimate& b, double level, double relativeMargin)
{
    Comparison result;
    result.margin = relativeMargin * std::max(std::abs(a.mean), std::abs(b.mean));
    const double gap = a.mean - b.mean, rest = std::max(std::abs(gap) - result.margin, 0.0);
    Estimate nearer = a;
    nearer.mean = b.mean + std::copysign(rest, gap);
    result.difference = statistics::compare(nearer, b);
    result.p = result.difference.p;
    if (rest > 0 && !(result.p >= level)) result.answer = Answer::Differ;
    return result;
}

Comparison compare(const Values& a, const Values& b, double level, double relativeMargin)
{
    Comparison result = compare(a.estimate, b.estimate, level, relativeMargin);
    if (result.answer != Answer::Differ) return result;
    const bool aIsHigher = a.estimate.mean > b.estimate.mean;
    const Values &high = aIsHigher ? a : b, &low = aIsHigher ? b : a;
    const Estimate brighter =
        high.values.empty() ? high.estimate : winsorized(high.values, ENOUGH_EVENTS * high.reach / low.chances);
    Estimate dimmer = low.estimate;
    dimmer.mean += unseenTail(low.values, low.estimate.mean);
    const bool still = low.chances >= ENOUGH_EVENTS && brighter.mean > dimmer.mean &&
                       compare(brighter, dimmer, level, relativeMargin).answer == Answer::Differ;
    if (!still) result.answer = Answer::Undecided;
    return result;
}

} // namespace hunt
