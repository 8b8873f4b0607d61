#include "ui/report/correlation_page.h"

#include <gtest/gtest.h>

#include "tests/passes/experiments/exact_correlation.h"

namespace
{

using namespace passes;
using namespace support;
using ui::verdictsOf;

} // namespace

TEST(CorrelationPage, SaysWhatItFound)
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
