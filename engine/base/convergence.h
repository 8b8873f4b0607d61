#pragma once
// Error against time: what curves of independent repeats say about methods. Errors and times are above 0 and are
// treated by their logarithms: errors of heavy-tailed estimators spread by factors, not by amounts.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/statistics.h"

namespace statistics
{

// Of one repeat: times (s, increasing) and the errors there. An error that is not above 0 (the reference is no better)
// ends what can be said about its neighborhood.
struct ErrorCurve {
    std::vector<double> seconds, errors; // as many of each
};

// Between points along a straight line of the logarithms; nothing outside of the curve.
std::optional<double> errorAt(const ErrorCurve& curve, double seconds);
// When the curve first comes down to the error; nothing when it does not, or is below it from the start.
std::optional<double> timeTo(const ErrorCurve& curve, double error);
// Least squares of log error against log time over the last decade of time; needs 3 points. -1 when independent
// samples are averaged; above it what is averaged is correlated, 0 is a plateau.
std::optional<double> slopeOf(const ErrorCurve& curve);

double median(std::vector<double> values); // of at least one; the mean of the middle two of an even number

// A geometric mean with its interval. Where the logarithms are spread evenly it is the median.
struct Factor {
    double value = 0;
    Interval interval;
};
Factor factorOf(std::span<const double> values, double level = 0.95);
// a / b, paired: element i of both is from repeat i, so what disturbs a repeat as a whole cancels. Of ratios the median
// and the geometric mean are the same thing as far as the logarithms are Gaussian, which the interval takes them to be.
Factor ratioOf(std::span<const double> a, std::span<const double> b, double level = 0.95);

// One method in a comparison: its error in each repeat, all at the same time (or otherwise made comparable).
struct Contender {
    std::string name;
    std::vector<double> errors;
};

// Who has the least error, and how sure that is.
struct Ranking {
    struct Place {
        size_t contender = 0;
        Factor ratio;          // its error to the winner's; 1 for the winner itself
        bool toldApart = true; // from the winner: the interval does not hold 1
    };
    std::vector<Place> places; // the least error first; empty when nothing can be compared
};
// Two repeats or more, as many of each contender. The level holds for all intervals together (Sidak, over
// all pairs, since the data chose the winner).
Ranking rank(std::span<const Contender> contenders, double level = 0.95);

// One plain sentence (or two): who wins, by how much, or that they cannot be told apart. `error` names the figure
// ("relative MSE"), `where` the condition ("In hall after 2 s of each method").
std::string verdict(std::span<const Contender> contenders, const std::string& error, const std::string& where,
                    double level = 0.95);

} // namespace statistics
