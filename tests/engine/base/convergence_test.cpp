// Curves with known slopes and crossings; coverage of intervals; who wins on synthetic errors.

#include "engine/base/convergence.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace statistics
{
namespace
{

// error = scale seconds^slope, at 1/8, 1/4, ... 64 s.
ErrorCurve powerLaw(double scale, double slope)
{
    ErrorCurve curve;
    for (int k = -3; k <= 6; ++k) {
        curve.seconds.push_back(std::exp2(k));
        curve.errors.push_back(scale * std::pow(curve.seconds.back(), slope));
    }
    return curve;
}

// Errors of `repeats` repeats: what disturbs a repeat as a whole, times factor, times noise of the method's own.
std::vector<double> synthetic(std::mt19937_64& random, const std::vector<double>& common, double factor, double noise)
{
    std::normal_distribution<double> gaussian(0, noise);
    std::vector<double> errors;
    for (const double c : common) errors.push_back(factor * c * std::exp(gaussian(random)));
    return errors;
}

std::vector<double> disturbances(std::mt19937_64& random, size_t repeats)
{
    return synthetic(random, std::vector<double>(repeats, 1), 1, 0.5);
}

std::string sentence(const std::vector<Contender>& contenders)
{
    return verdict(contenders, "relative MSE", "In hall after 2 s each,");
}

void expectPart(const std::string& text, const std::string& part)
{
    EXPECT_NE(text.find(part), std::string::npos) << text;
}

} // namespace

TEST(ErrorCurve, IsReadBetweenItsPointsAlongPowerLaws)
{
    const ErrorCurve curve = powerLaw(3, -0.7);
    for (const double t : {0.125, 0.2, 1.0, 5.0, 63.9, 64.0}) {
        ASSERT_TRUE(errorAt(curve, t)) << t;
        EXPECT_NEAR(*errorAt(curve, t), 3 * std::pow(t, -0.7), 1e-12) << t;
        if (t == 0.125) continue;
        ASSERT_TRUE(timeTo(curve, 3 * std::pow(t, -0.7))) << t;
        EXPECT_NEAR(*timeTo(curve, 3 * std::pow(t, -0.7)), t, 1e-10 * t) << t;
    }
    EXPECT_FALSE(errorAt(curve, 0.12));
    EXPECT_FALSE(errorAt(curve, 64.1));
    EXPECT_FALSE(timeTo(curve, 1e-3));
    EXPECT_FALSE(timeTo(curve, 100)); // below it from the start: when it got there is not known
}

TEST(ErrorCurve, SaysNothingWhereTheErrorIsNotAboveZero)
{
    ErrorCurve curve = powerLaw(1, -1);
    curve.errors.back() = -1e-9;
    EXPECT_FALSE(errorAt(curve, 50));
    EXPECT_TRUE(errorAt(curve, 31));
    EXPECT_FALSE(timeTo(curve, 1 / 40.0));
    EXPECT_TRUE(timeTo(curve, 1 / 31.0));
    EXPECT_FALSE(slopeOf(curve));
}

TEST(ErrorCurve, HasTheSlopeOfItsLastDecade)
{
    for (const double slope : {-1.0, -0.5, 0.0}) EXPECT_NEAR(*slopeOf(powerLaw(2, slope)), slope, 1e-12);
    ErrorCurve bent = powerLaw(1, -1); // 6.4 s begin the last decade: 8, 16, 32 and 64 s count
    for (size_t i = 0; i < bent.seconds.size(); ++i)
        if (bent.seconds[i] >= 8) bent.errors[i] = bent.errors[6];
    EXPECT_NEAR(*slopeOf(bent), 0, 1e-12);
    EXPECT_FALSE(slopeOf({{1, 2}, {1, 2}}));
    // By hand: logs to base 2 are (0, 0), (1, -1), (2, -3): sum of (x - 1)(y + 4/3) is -3, of squares 2.
    EXPECT_NEAR(*slopeOf({{1, 2, 4}, {1, 0.5, 0.125}}), -1.5, 1e-12);
}

TEST(Factors, ByHand)
{
    EXPECT_EQ(median({3, 1, 2}), 2);
    EXPECT_EQ(median({4, 1, 2, 8}), 3);
    const std::vector<double> a = {2, 8}, b = {1, 1};
    const Factor ratio = ratioOf(a, b);
    EXPECT_NEAR(ratio.value, 4, 1e-12);
    // logs to base 2 are 1 and 3: standard error 1, one degree of freedom, t = 12.706.
    EXPECT_NEAR(std::log2(ratio.interval.low), 2 - 12.7062, 1e-3);
    EXPECT_NEAR(std::log2(ratio.interval.high), 2 + 12.7062, 1e-3);
    EXPECT_NEAR(ratioOf(b, a).value, 0.25, 1e-12);
}

// 95% intervals hold the truth in 93 to 97% of 1000 trials.
TEST(Factors, IntervalsOfRatiosCover)
{
    std::mt19937_64 random(1);
    for (const size_t repeats : {4u, 8u, 20u}) {
        int held = 0, heldAlone = 0;
        for (int trial = 0; trial < 1000; ++trial) {
            const std::vector<double> common = disturbances(random, repeats);
            const std::vector<double> a = synthetic(random, common, 3, 0.2), b = synthetic(random, common, 2, 0.3);
            const Factor ratio = ratioOf(a, b), alone = factorOf(a);
            held += ratio.interval.low < 1.5 && 1.5 < ratio.interval.high;
            heldAlone += alone.interval.low < 3 && 3 < alone.interval.high;
        }
        EXPECT_GE(held, 930) << repeats;
        EXPECT_LE(held, 970) << repeats;
        EXPECT_GE(heldAlone, 930) << repeats;
        EXPECT_LE(heldAlone, 970) << repeats;
    }
}

// The same for errors as pictures have them: mean squares of 1000 heavy-tailed pixels (most paths dark, some bright).
TEST(Factors, IntervalsCoverForMeanSquaresOfHeavyTails)
{
    std::mt19937_64 random(2);
    std::lognormal_distribution<double> tail(0, 1);
    const auto mse = [&](double scale) {
        double sum = 0;
        for (int pixel = 0; pixel < 1000; ++pixel) sum += scale * std::pow(tail(random) - std::exp(0.5), 2) / 1000;
        return sum;
    };
    int held = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        std::vector<double> a, b;
        for (int repeat = 0; repeat < 8; ++repeat) {
            a.push_back(mse(2));
            b.push_back(mse(1));
        }
        const Interval interval = ratioOf(a, b).interval;
        held += interval.low < 2 && 2 < interval.high;
    }
    EXPECT_GE(held, 930);
    EXPECT_LE(held, 970);
}

// Slopes of noisy curves whose points share their past, as running means do: each repeat gives one slope.
TEST(Factors, IntervalsOfSlopesCover)
{
    std::mt19937_64 random(3);
    std::normal_distribution<double> gaussian;
    int held = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        Moments slopes;
        for (int repeat = 0; repeat < 8; ++repeat) {
            ErrorCurve curve = powerLaw(1, -1);
            double walk = 0;
            for (double& error : curve.errors) error *= std::exp(walk += 0.1 * gaussian(random));
            slopes.add(*slopeOf(curve));
        }
        const Interval interval = meanInterval(estimateOf(slopes));
        held += interval.low < -1 && -1 < interval.high;
    }
    EXPECT_GE(held, 930);
    EXPECT_LE(held, 970);
}

TEST(Verdict, NamesTheWinnerAndByHowMuch)
{
    std::mt19937_64 random(4);
    const std::vector<double> common = disturbances(random, 8);
    const std::string text = sentence({{"pt", synthetic(random, common, 4, 0.05)},
                                       {"rgb", synthetic(random, common, 1, 0.05)},
                                       {"lum", synthetic(random, common, 2, 0.05)}});
    expectPart(text, "In hall after 2 s each, rgb has the least relative MSE");
    expectPart(text, "less than lum and");
    expectPart(text, "less than pt");
    EXPECT_LT(text.find("less than lum"), text.find("less than pt")); // the nearest first
    expectPart(text, "paired over 8 repeats");
}

TEST(Verdict, SaysWhatCannotBeToldApart)
{
    std::mt19937_64 random(5);
    const std::vector<double> common = disturbances(random, 8);
    const std::vector<double> one = synthetic(random, common, 1, 0.3), two = synthetic(random, common, 1, 0.3);
    expectPart(sentence({{"a", one}, {"b", two}}), "cannot be told apart by their relative MSE");
    const std::string three = sentence({{"a", one}, {"b", two}, {"pt", synthetic(random, common, 9, 0.3)}});
    expectPart(three, "cannot be told apart");
    expectPart(three, "less than pt");
}

// What is paired out: repeats that differ by factors do not hide a difference of 3%.
TEST(Verdict, ComparesWithinRepeats)
{
    std::mt19937_64 random(6);
    const std::vector<double> common = disturbances(random, 8);
    const Ranking ranking = rank(std::vector<Contender>{{"a", synthetic(random, common, 1.03, 0.005)},
                                                        {"b", synthetic(random, common, 1, 0.005)}});
    ASSERT_EQ(ranking.places.size(), 2u);
    EXPECT_EQ(ranking.places[0].contender, 1u);
    EXPECT_TRUE(ranking.places[1].toldApart);
    EXPECT_NEAR(ranking.places[1].ratio.value, 1.03, 0.01);
}

TEST(Verdict, SeldomFindsADifferenceWhereThereIsNone)
{
    std::mt19937_64 random(7);
    int found = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        const std::vector<double> common = disturbances(random, 8);
        std::vector<Contender> equals;
        for (const char* name : {"a", "b", "c"}) equals.push_back({name, synthetic(random, common, 1, 0.3)});
        const Ranking ranking = rank(equals);
        found += ranking.places[1].toldApart || ranking.places[2].toldApart;
    }
    EXPECT_LE(found, 70); // at most 5%, and 2.9 standard errors of that
}

TEST(Verdict, NeedsRepeatsAndErrorsAboveZero)
{
    expectPart(sentence({{"a", {1}}, {"b", {2}}}), "nothing can be said");
    expectPart(sentence({{"a", {1, 2}}}), "nothing can be said");
    expectPart(sentence({{"a", {1, -2}}, {"b", {1, 2}}}), "nothing can be said");
    expectPart(sentence({{"a", {}}, {"b", {}}}), "nothing can be said");
}

} // namespace statistics
