// The page, table and verdicts of `converge` from synthetic repeats.
// Covers ui/report/converge_plots.cpp.

#include "ui/report/converge_page.h"

#include "tests/passes/experiments/repeats.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace
{

ui::ConvergeReport reportOf(double factor, bool moving = false)
{
    ui::ConvergeReport report{.scene = "hall", .methods = ui::readMethods("pt,rgb-restir", {}), .moving = moving};
    report.provenance = {.command = "trichrome converge hall -o out", .scene = "hall", .device = "d", .driver = "e"};
    for (uint64_t seed = 0; seed < 8; ++seed) report.repeats.push_back(support::repeatOf(seed, factor, moving));
    return report;
}

void expectPart(const std::string& text, const std::string& part)
{
    EXPECT_NE(text.find(part), std::string::npos) << "expected: " << part << "\n" << text.substr(0, 3000);
}

size_t count(const std::string& text, const std::string& part)
{
    size_t found = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

} // namespace

TEST(ConvergePage, ComparesMeansAtEqualTimeAndFramesFrameByFrame)
{
    // A quarter of the error at twice the time a frame: half the error at equal time.
    const std::vector<std::string> wins = ui::convergeVerdicts(reportOf(0.25));
    ASSERT_EQ(wins.size(), 2u);
    expectPart(wins[0], "equal time (3.2 s each): rgb-restir has the least relative MSE: ");
    const double ratio = std::stod(wins[0].substr(wins[0].find("MSE: ") + 5));
    EXPECT_NEAR(ratio, 2, 0.15);
    const double single = std::stod(wins[1].substr(wins[1].find("MSE: ") + 5));
    EXPECT_NEAR(single, 4, 0.3);
    // Three quarters: pt wins at equal time and loses frame by frame.
    const std::vector<std::string> loses = ui::convergeVerdicts(reportOf(0.75));
    expectPart(loses[0], "pt has the least relative MSE");
    expectPart(loses[1], "rgb-restir has the least relative MSE");
    expectPart(ui::convergeVerdicts(reportOf(0.5))[0], "cannot be told apart");
}

TEST(ConvergePage, AMovingCameraIsComparedByErrorTimesTimeOfAFrame)
{
    const std::vector<std::string> wins = ui::convergeVerdicts(reportOf(0.25, true));
    ASSERT_EQ(wins.size(), 2u);
    expectPart(wins[0], "rgb-restir has the least relative MSE: ");
    expectPart(wins[1], "rgb-restir has the least relative MSE: ");
    EXPECT_NEAR(std::stod(wins[1].substr(wins[1].find("MSE: ") + 5)), 2, 0.15);
    expectPart(ui::convergeVerdicts(reportOf(0.75, true))[1], "pt has the least relative MSE");
}

TEST(ConvergePage, HoldsTablesCurvesAndHowItWasMeasured)
{
    const ui::ConvergeReport report = reportOf(0.25);
    const std::vector<ui::NamedPlot> plots = ui::convergePlots(report);
    const std::string page = ui::convergePage(report, plots);
    for (const char* part : {"class=\"verdict\"", "Means of all frames, after 3.2 s", "Single frames, after 32",
                             "trichrome converge hall -o out", "Andersson et al. 2020", "paired ratios", "not finite"})
        expectPart(page, part);
    EXPECT_EQ(page.find("http:"), page.find("http://www.w3.org")); // namespaces of the plots are all that looks so
    if (plots.empty()) GTEST_SKIP() << "SKIPPED, PLOTS NOT TESTED: gnuplot is not installed";
    EXPECT_EQ(count(page, "<svg"), plots.size());
    EXPECT_EQ(plots.size(), 4u);
    EXPECT_EQ(ui::convergePlots(reportOf(0.25, true)).size(), 3u);
    expectPart(plots[0].svg, "slope -1");
}

TEST(ConvergePage, SaysSoWhereThereIsNothingYet)
{
    ui::ConvergeReport report = reportOf(0.25);
    report.repeats.clear();
    report.provenance.partial = true;
    const std::string page = ui::convergePage(report, ui::convergePlots(report));
    expectPart(page, "Partial:");
    expectPart(page, "No repeat was measured");
}

TEST(ConvergePage, UsesCompleteRepeatsAndOtherwiseWhatThereIs)
{
    ui::ConvergeReport report = reportOf(0.25);
    report.repeats.push_back({.samples = {report.repeats[0].samples[0]}}); // stopped after one frame
    expectPart(ui::convergeVerdicts(report)[0], "over 8 repeats");
    EXPECT_EQ(count(ui::convergeCsv(report), "\n"), 1 + 8 * 24 + 1u); // but the table has all
    for (passes::Repeat& repeat : report.repeats) repeat.complete = false;
    EXPECT_EQ(passes::RaceFigures(report.repeats).repeats(), 9u);
}

TEST(ConvergeCsv, BeginsWithTheColumnsOfTheContract)
{
    const std::string csv = ui::convergeCsv(reportOf(0.25));
    EXPECT_EQ(
        csv.substr(0, csv.find('\n'))
            .find("scene,method,shift,max_confidence,repeat,frames,seconds,mse,relmse,psnr,ssim,flip,chroma_mse,"),
        0u);
    expectPart(csv, "\nhall,pt,hybrid,20,0,1,0.1,");
    expectPart(csv, ",nan,");
}
