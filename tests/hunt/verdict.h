#pragma once
// When do two estimates differ? Asked of millions of cases, so a difference is believed only when it was found three
// times with fresh random numbers, and only when it cannot be light that one of the two was too short to meet.

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/statistics.h"

namespace hunt
{

// Level of each of the three tests that a find has to pass: the first over all regions of the picture, the others of
// the one region and channel that the first has named, each with more samples than the one before. A right case passes
// all of them with a probability below their product, 1e-15: below 1e-6 in a billion cases.
constexpr double LEVELS[] = {1e-3, 1e-4, 1e-8};

// Independent values of one quantity by one method.
struct Values {
    std::vector<double> values; // may be empty: then `estimate` is all that is known
    statistics::Estimate estimate;
    double chances = 0; // of all values to have met a rare path, at least: the frames that they rest on
    double reach = 1;   // chances of one value, at most

    void add(double value) { values.push_back(value); }
    void finish(double chancesEach, double reachOfEach = 1); // makes the estimate
};

// The events that a method is trusted to have met have happened so often, on average. With 60 of them the mean is known
// to 13%, and a shortage that would pass for a difference of six standard errors is rarer than 1e-8.
constexpr double ENOUGH_EVENTS = 60;
// Resampling makes values x with a probability of order 1/x: a dim path of a bright pixel's tree is chosen rarely and
// then counts much. Of such a law, the values beyond the largest of n seen hold, for each factor of e, as much as that
// one over n does; here are 16 of them (10^7), twice, since the largest is a random number itself.
constexpr double UNSEEN_TAIL = 32;

enum class Answer { Agree, Undecided, Differ };
struct Comparison {
    Answer answer = Answer::Agree;
    double p = 1;      // two-sided, of Welch's test
    double margin = 0; // what rounding may make, in the quantity's unit
    statistics::Difference difference;
};

// Differ: by more than `relativeMargin` of the larger mean at the level, and still so when both are changed in favor of
// agreement: the larger one's rare and bright values, those that the other can be expected to have met fewer than
// ENOUGH_EVENTS times, cut to the brightest of its other values; and the smaller one's mean raised by the tail that its
// own largest values let one expect. Undecided: without these changes only, or the smaller one's chances are too few
// for any of this.
Comparison compare(const Values& a, const Values& b, double level, double relativeMargin);

// Of the means alone, as the first tests do.
Comparison compare(const statistics::Estimate& a, const statistics::Estimate& b, double level, double relativeMargin);

} // namespace hunt
