// Estimator tables: those that ship are unbiased, and others are refused with the reason.

#include "passes/estimator.h"

#include "engine/base/error.h"

#include <gtest/gtest.h>

#include <limits>

using passes::Estimator;

namespace
{

std::string refusal(const Estimator& estimator)
{
    try {
        passes::checkUnbiased(estimator);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

const glm::vec3 ALL(1), RED(1, 0, 0), CYAN(0, 1, 1);

} // namespace

TEST(Estimators, ShippedTablesAreUnbiased)
{
    ASSERT_EQ(passes::estimators().size(), 3u);
    for (const Estimator& estimator : passes::estimators()) EXPECT_EQ(refusal(estimator), "") << estimator.name;
}

TEST(Estimators, AreInTheOrderOfTheMethods)
{
    passes::Settings settings;
    for (const Estimator& estimator : passes::estimators()) {
        passes::set(settings, "method", estimator.name);
        EXPECT_EQ(passes::estimatorOf(settings.method).name, estimator.name);
    }
}

TEST(Estimators, OthersAreRefused)
{
    EXPECT_NE(refusal({"half", {ALL}, {0.5f * ALL}}).find("sum to 0.5"), std::string::npos);
    EXPECT_NE(refusal({"twice", {ALL, ALL}, {ALL, RED}}).find("sum to 2"), std::string::npos);
    EXPECT_NE(refusal({"blind", {RED}, {ALL}}).find("leaves out"), std::string::npos);
    EXPECT_NE(refusal({"negative", {ALL, ALL}, {2.0f * ALL, -1.0f * ALL}}).find("below 0"), std::string::npos);
    EXPECT_NE(refusal({"endless", {std::numeric_limits<float>::infinity() * ALL}, {ALL}}).find("not finite"),
              std::string::npos);
    EXPECT_NE(refusal({"empty", {}, {}}).find("0 targets"), std::string::npos);
    EXPECT_NE(refusal({"five", std::vector<glm::vec3>(5, ALL), std::vector<glm::vec3>(5, 0.2f * ALL)}).find("1 to 4"),
              std::string::npos);
    EXPECT_NE(refusal({"uneven", {RED, CYAN}, {ALL}}).find("2 targets and 1"), std::string::npos);
    EXPECT_EQ(refusal({"split", {RED, CYAN}, {RED, CYAN}}), "");
}
