#include "passes/experiments/correlation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/passes/experiments/exact_correlation.h"

namespace
{

using namespace passes;
using namespace support;

} // namespace

TEST(Correlation, MeasuresPredictsAndFindsTheCrossover)
{
    const Correlation correlation = evaluated(100);
    ASSERT_EQ(correlation.curves.size(), 2u);
    for (const Curve& curve : correlation.curves) {
        std::vector<uint32_t> frames;
        for (const CurvePoint& point : curve.points) {
            frames.push_back(point.frame);
            EXPECT_EQ(point.runs, point.frame <= 4 ? 6u : 0u);
            ASSERT_TRUE(point.law);
            if (point.runs > 0) {
                EXPECT_NEAR(point.autocovariance.mean, point.law->mean, 1e-12);
                EXPECT_LT(std::abs(point.z()), 1e-6);
            } else {
                EXPECT_TRUE(std::isnan(point.z()));
            }
        }
        EXPECT_EQ(frames, (std::vector<uint32_t>{2, 4, 8, 16, 32, 64, 100}));
    }
    EXPECT_NEAR(correlation.curves[0].points.back().law->mean, 0.1 + 0.098, 1e-12);
    EXPECT_NEAR(correlation.curves[1].points.back().law->mean, 0.08, 1e-12);
    // The mean of four frames: of V the pairs' (1 + 3/2 + 5/3 + 7/4) / 16, of P (1/2 + 4/3 + 9/4) / 16.
    ASSERT_TRUE(correlation.curves[0].points[1].filmLaw);
    EXPECT_NEAR(correlation.curves[0].points[1].film->mean, 5.5, 1e-12);
    EXPECT_NEAR(correlation.curves[0].points[1].filmLaw->mean, 10 * (71.0 / 12) / 16 + 0.1 * (49.0 / 12) / 16, 1e-12);
    ASSERT_EQ(correlation.curves[1].points[1].lags.size(), 1u);
    EXPECT_NEAR(correlation.curves[1].points[1].lags[0].autocovariance.mean, 2, 1e-12);
    EXPECT_NEAR(correlation.curves[1].points[1].lags[0].law->mean, 2, 1e-12);
    const auto cross = crossover(correlation, correlation.curves[0]);
    ASSERT_TRUE(cross);
    EXPECT_LT(cross->low, 80);
    EXPECT_GT(cross->high, 80);
    EXPECT_NEAR(std::sqrt(cross->low * cross->high), 80, 1e-9);
    EXPECT_FALSE(crossover(correlation, correlation.curves[1])); // no plateau, no crossover
}

// Weighted color has the same plateau, comes to it later, and starts with whole trees: sigma^2 / 2, not V / 2.
TEST(Correlation, PredictsWeightedColor)
{
    Correlation correlation{.scene = "s", .width = 2, .height = 1, .runs = 3};
    evaluate(correlation, methods(1 << 20, passes::Color::Weighted), exact(0));
    const std::vector<CurvePoint>& points = correlation.curves.at(0).points;
    ASSERT_EQ(points.size(), 20u);
    EXPECT_NEAR(points[0].law->mean, 8.0 / 2, 1e-12);
    EXPECT_NEAR(points[1].law->mean, 10.0 / 4 + 0.1 * (2.0 / 4) * (1.0 / 3), 1e-12);
    EXPECT_NEAR(points[2].law->mean, 10.0 / 8 + 0.1 * (6.0 / 8) * (5.0 / 7), 1e-12);
    EXPECT_NEAR(points[19].law->mean, 0.1 + 9.6 / (1 << 20), 1e-9);
    EXPECT_NEAR(correlation.curves[1].points[1].law->mean, 8.0 / 4, 1e-12); // reservoirs of their own: as ever
}

TEST(Correlation, NeitherOrderNorDoublesChangeABit)
{
    Correlation again{.scene = "a <scene>", .width = 2, .height = 1, .runs = 6};
    std::vector<CorrelationBatch> batches = exact(1);
    for (const CorrelationBatch& batch : exact(0)) batches.push_back(batch);
    for (const CorrelationBatch& batch : exact(1)) batches.push_back(batch);
    std::ranges::reverse(batches);
    evaluate(again, methods(100), batches);
    EXPECT_EQ(csvOf(again), csvOf(evaluated(100)));
}

TEST(Correlation, TheCsvHasTheContractsColumns)
{
    const std::string csv = csvOf(evaluated(8));
    EXPECT_EQ(
        csv.find(
            "scene,method,shift,max_confidence,runs,pixels,autocovariance,ci_low,ci_high,predicted,sigma2,plateau"),
        0u);
    EXPECT_NE(csv.find("a <scene>,restir-pt,hybrid,4,6,2,2.55"), std::string::npos) << csv;
    EXPECT_NE(csv.find("a <scene>,rgb-restir,hybrid,8,0,0,nan,nan,nan,1,8,0"), std::string::npos) << csv;
}
