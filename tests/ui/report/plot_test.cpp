#include "ui/report/plot.h"

#include <cstdlib>

#include <gtest/gtest.h>

namespace
{

ui::Plot example()
{
    return {.title = "Error \"quoted\" \\ of",
            .xLabel = "time (s)",
            .yLabel = "MSE",
            .logX = true,
            .logY = true,
            .series = {{.name = "pt_x", .x = {0, 1, 10}, .y = {5, 1, 0.1}, .low = {1, 0.5, -1}, .high = {9, 2, 0.2}},
                       {.name = "law", .mark = ui::Series::Mark::Dashed, .color = 1, .x = {1, 10}, .y = {1, 0.1}}}};
}

} // namespace

TEST(Plot, LeavesOutWhatALogarithmicAxisCannotShow)
{
    const std::string script = ui::gnuplotScript(example());
    EXPECT_EQ(script.find("\n0 5"), std::string::npos);
    EXPECT_NE(script.find("\n1 1 0.5 2"), std::string::npos);
    EXPECT_NE(script.find("title \"law\""), std::string::npos);
    EXPECT_NE(script.find("Error \\\"quoted\\\" \\\\ of"), std::string::npos);
}

TEST(Plot, IsDrawnByGnuplot)
{
    if (std::system("gnuplot --version >/dev/null 2>&1") != 0)
        GTEST_SKIP() << "SKIPPED, NOT TESTED: gnuplot is not installed";
    const std::optional<std::string> svg = ui::drawSvg(example());
    ASSERT_TRUE(svg);
    EXPECT_NE(svg->find("pt_x"), std::string::npos); // no subscripts
    EXPECT_NE(svg->find("MSE"), std::string::npos);
    EXPECT_NE(svg->find("213,  94,   0"), std::string::npos); // the second color
    EXPECT_EQ(svg->find("</svg>") + 6, svg->find_last_not_of('\n') + 1);

    ui::Plot empty = example();
    empty.series.clear();
    EXPECT_TRUE(ui::drawSvg(empty));
}

TEST(Plot, DoesWithoutGnuplot)
{
    const std::string path = std::getenv("PATH");
    setenv("PATH", "/nonexistent", 1);
    EXPECT_FALSE(ui::drawSvg(example()));
    setenv("PATH", path.c_str(), 1);
}
