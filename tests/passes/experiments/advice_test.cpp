// What advice follows from figures; tests/ui/commands/info_test.cpp measures some.

#include "passes/experiments/advice.h"

#include <gtest/gtest.h>

namespace
{

using passes::Advice;

// Of three methods, the cheapest first: how many times less error in the same time, between which bounds.
Advice adviceOf(const statistics::Factor& second, const statistics::Factor& third)
{
    return {.rows = {{.method = "plain", .milliseconds = 10, .error = 0.1, .gain = {1, {1, 1}}},
                     {.method = "beside", .milliseconds = 10, .error = 0.05, .gain = second},
                     {.method = "each", .milliseconds = 15, .error = 0.04, .gain = third}},
            .variance = 8,
            .plateau = 2,
            .treesPerPixel = 1.5,
            .width = 96,
            .height = 54,
            .degrees = 0.3};
}

std::string textOf(const Advice& advice, uint32_t maxConfidence)
{
    std::string text;
    for (const std::string& sentence : sentencesOf(advice, {.maxConfidence = maxConfidence})) text += sentence + "\n";
    return text;
}

TEST(Advice, IsTheCheapestThatCannotBeToldFromTheBest)
{
    EXPECT_EQ(adviceOf({2, {1.8, 2.2}}, {1.5, {1.3, 1.7}}).best(), 1u);
    EXPECT_EQ(adviceOf({2, {1.8, 2.2}}, {2.1, {1.9, 2.3}}).best(), 1u);
    EXPECT_EQ(adviceOf({1.2, {1.1, 1.3}}, {2, {1.8, 2.2}}).best(), 2u);
    EXPECT_EQ(adviceOf({1.1, {0.97, 1.2}}, {0.96, {0.91, 1}}).best(), 0u);
    EXPECT_EQ(adviceOf({0.8, {0.7, 0.9}}, {0.6, {0.5, 0.7}}).best(), 0u);
}

TEST(Advice, IsSaidWithItsFigures)
{
    const std::string gains = textOf(adviceOf({2, {1.8, 2.2}}, {1.5, {1.3, 1.7}}), 20);
    for (const char* part :
         {"Use beside: ", "K = 3, M_c = 20 and hybrid shifts", "2 times (1.8 to 2.2) less error than plain",
          "M* = 4 frames", "beyond that", "1.50 different paths", "96x54"})
        EXPECT_NE(gains.find(part), std::string::npos) << part << " in:\n" << gains;
    const std::string none = textOf(adviceOf({1, {0.9, 1.1}}, {0.9, {0.8, 1}}), 3);
    for (const char* part : {"Use plain: ", "no other has less error", "M_c ends history before that"})
        EXPECT_NE(none.find(part), std::string::npos) << part << " in:\n" << none;
    Advice white = adviceOf({1, {0.9, 1.1}}, {0.9, {0.8, 1}});
    white.plateau = 0;
    EXPECT_NE(textOf(white, 20).find("no color noise"), std::string::npos);
}

} // namespace
