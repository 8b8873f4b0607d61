// The page, table and verdicts of `converge` from synthetic repeats, and repeats on disk.

#include "ui/report/converge_page.h"
#include "ui/report/race_store.h"

#include "engine/base/error.h"
#include "tests/support/program.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace
{

constexpr uint64_t FRAMES[] = {1, 2, 4, 8, 16, 32};

// pt's error is 1/frames at 0.1 s a frame; the other one's `factor` as much at 0.2 s a frame.
passes::Repeat repeatOf(uint64_t seed, double factor, bool moving)
{
    std::mt19937_64 random(seed);
    std::normal_distribution<double> gaussian(0, 0.05);
    passes::Repeat repeat{.complete = true};
    for (const uint64_t frames : FRAMES)
        for (uint32_t method = 0; method < 2; ++method)
            for (const bool average : {true, false}) {
                if (moving && average) continue;
                passes::Sample s{.method = method, .average = average, .frames = frames};
                s.wallSeconds = s.deviceSeconds = double(frames) * (method == 0 ? 0.1 : 0.2);
                const double error = (method == 0 ? 1 : factor) / (average ? double(frames) : 1);
                s.error.mse = error * std::exp(gaussian(random));
                s.error.relmse = s.error.mse;
                s.error.lumaMse = s.error.chromaMse = s.error.mse / 2;
                s.error.psnr = -10 * std::log10(s.error.mse);
                s.error.ssim = 0.9;
                s.error.flip = std::numeric_limits<double>::quiet_NaN();
                repeat.samples.push_back(s);
            }
    return repeat;
}

ui::ConvergeReport reportOf(double factor, bool moving = false)
{
    ui::ConvergeReport report{.scene = "hall", .methods = ui::readMethods("pt,rgb-restir", {}), .moving = moving};
    report.provenance = {.command = "trichrome converge hall -o out", .scene = "hall", .device = "d", .driver = "e"};
    for (uint64_t seed = 0; seed < 8; ++seed) report.repeats.push_back(repeatOf(seed, factor, moving));
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

TEST(RaceFigures, FallBackToWallTimeWhereTheDeviceHasNoClock)
{
    ui::ConvergeReport report = reportOf(1);
    report.repeats[0].samples[3].deviceSeconds = 0;
    report.repeats[0].samples[3].wallSeconds = 7;
    const passes::RaceFigures figures(report.repeats);
    EXPECT_FALSE(figures.deviceClock());
    EXPECT_EQ(figures.seconds(report.repeats[0].samples[3]), 7);
}

TEST(RaceStore, GivesBackWhatWasFinished)
{
    const TemporaryDirectory directory;
    const ui::RaceStore store(directory / "out", "key", {"pt", "rgb-restir:spatial=0"});
    EXPECT_TRUE(store.read(9).empty());
    passes::Repeat repeat = repeatOf(3, 0.25, false);
    repeat.samples[1].error.psnr = std::numeric_limits<double>::infinity();
    repeat.nonFinite = 2;
    repeat.finals.assign(2, {.width = 1, .height = 1, .pixels = {{0.5f, 1, 2}}});
    store.write(0, repeat);
    store.write(1, repeat);
    EXPECT_EQ(store.read(1).size(), 1u);
    const std::vector<passes::Repeat> back = store.read(9);
    ASSERT_EQ(back.size(), 2u);
    EXPECT_TRUE(back[0].complete);
    EXPECT_EQ(back[0].nonFinite, 2u);
    ASSERT_EQ(back[0].samples.size(), repeat.samples.size());
    for (size_t i = 0; i < repeat.samples.size(); ++i) {
        const passes::Sample &a = back[0].samples[i], &b = repeat.samples[i];
        EXPECT_EQ(a.method, b.method);
        EXPECT_EQ(a.average, b.average);
        EXPECT_EQ(a.frames, b.frames);
        EXPECT_EQ(a.deviceSeconds, b.deviceSeconds);
        EXPECT_EQ(a.error.relmse, b.error.relmse);
        EXPECT_EQ(a.error.psnr, b.error.psnr);
        EXPECT_EQ(a.error.chromaMse, b.error.chromaMse);
        EXPECT_TRUE(std::isnan(a.error.flip));
    }
    EXPECT_EQ(image::read(store.picture(1)).image.pixels, repeat.finals[1].pixels);
    EXPECT_EQ(store.picture(1).filename(), "01-rgb-restir_spatial_0.exr");
    EXPECT_THROW(store.requireNew(), Error);
    EXPECT_NO_THROW(ui::RaceStore(directory / "elsewhere", "key", {"pt"}).requireNew());
}

TEST(RaceStore, RefusesOtherSettingsAndDamage)
{
    const TemporaryDirectory directory;
    const std::string out = directory / "out";
    const ui::RaceStore store(out, "key", {"pt", "b"});
    store.write(1, repeatOf(1, 1, false));
    EXPECT_TRUE(store.read(9).empty()); // the first is missing
    passes::Repeat repeat = repeatOf(1, 1, false);
    repeat.finals.assign(2, {.width = 1, .height = 1, .pixels = {{0, 0, 0}}});
    store.write(0, repeat);
    EXPECT_THROW(ui::RaceStore(out, "other", {"pt", "b"}).read(9), Error);
    EXPECT_THROW(ui::RaceStore(out, "key", {"pt"}).read(9), Error); // a method that there is not
    for (const char* damaged : {"", "{", "{}", R"({"key": "key", "nonfinite": 0, "samples": [[0, true, 1]]})"}) {
        writeFile(out + "/repeats/0000.json", damaged);
        EXPECT_THROW(store.read(9), Error) << damaged;
    }
}
