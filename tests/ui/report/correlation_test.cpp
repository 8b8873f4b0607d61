#include "ui/report/correlation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ui/report/correlation_page.h"
#include "ui/report/correlation_store.h"

namespace
{

using namespace ui;

statistics::BatchValue about(double value)
{
    return {.value = value, .without = {0.99 * value, value, 1.01 * value}};
}

passes::FrameLaw law(double variance, double plateau)
{
    return {.variance = about(variance),
            .plateau = plateau > 0 ? about(plateau) : statistics::BatchValue{.value = 0, .without = {0, 0, 0}},
            .floor = {glm::dvec3(plateau), glm::dvec3(plateau / 3)},
            .mean = {glm::dvec3(1), glm::dvec3(1.0 / 7)}};
}

std::vector<NamedMethod> methods(uint32_t maxConfidence, passes::Color color = passes::Color::Chosen)
{
    passes::Settings settings;
    settings.temporal = true;
    settings.spatial = 0;
    settings.maxConfidence = maxConfidence;
    settings.color = color;
    return readMethods("restir-pt,rgb-restir", settings);
}

// sigma^2 = 8, V = 10, P = 0.1: what a measurement to M = 4 without any error would give.
std::vector<CorrelationBatch> exact(uint32_t index)
{
    CorrelationBatch plain{.method = PATH_TRACER, .index = index, .runs = 3, .law = law(8, 0)};
    CorrelationBatch one{.method = "restir-pt", .index = index, .runs = 3, .law = law(10, 0.1)};
    CorrelationBatch each{.method = "rgb-restir", .index = index, .runs = 3};
    for (const uint32_t frame : {2u, 4u}) {
        one.points.push_back({frame, 2, about(10.0 / frame + (1 - 2.0 / frame) * 0.1), about(6)});
        each.points.push_back({frame, 2, about(8.0 / frame), about(5)});
    }
    return {plain, one, each};
}

Correlation evaluated(uint32_t maxConfidence)
{
    Correlation correlation{.scene = "a <scene>", .width = 2, .height = 1, .runs = 6};
    std::vector<CorrelationBatch> batches = exact(0);
    for (const CorrelationBatch& batch : exact(1)) batches.push_back(batch);
    evaluate(correlation, methods(maxConfidence), batches);
    return correlation;
}

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

TEST(Correlation, SaysWhatItFound)
{
    std::string said;
    for (const std::string& sentence : verdictsOf(evaluated(1024))) said += sentence + "\n";
    for (const char* part :
         {"At M = 4", "Predicted at M = 1024", "M* = σ²/P = 80", "agree", "progressive accumulation"})
        EXPECT_NE(said.find(part), std::string::npos) << part << " in:\n" << said;

    // A planted error of 2% shows when intervals are narrower than that.
    Correlation wrong{.scene = "s", .width = 2, .height = 1};
    std::vector<CorrelationBatch> batches = exact(0);
    batches[1].points[0].autocovariance.value *= 1.02;
    for (double& value : batches[1].points[0].autocovariance.without) value = batches[1].points[0].autocovariance.value;
    batches[1].law->variance.without = {10.001, 10, 9.999};
    evaluate(wrong, methods(4), batches);
    said.clear();
    for (const std::string& sentence : verdictsOf(wrong)) said += sentence;
    EXPECT_NE(said.find("DISAGREE"), std::string::npos) << said;
    EXPECT_NE(verdictsOf(Correlation{}).front().find("Nothing was measured"), std::string::npos);
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

TEST(CorrelationStore, GivesBatchesBackExactly)
{
    for (const CorrelationBatch& batch : exact(3)) EXPECT_EQ(fromBytes(toBytes(batch)), batch);
    EXPECT_ANY_THROW(fromBytes(Bytes(10)));
}
