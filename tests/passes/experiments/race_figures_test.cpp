#include "passes/experiments/race_figures.h"

#include "tests/passes/experiments/repeats.h"

#include <gtest/gtest.h>

TEST(RaceFigures, FallBackToWallTimeWhereTheDeviceHasNoClock)
{
    std::vector<passes::Repeat> repeats = {support::repeatOf(0, 1, false)};
    EXPECT_TRUE(passes::RaceFigures(repeats).deviceClock());
    passes::Sample& sample = repeats[0].samples[3];
    sample.deviceSeconds = 0;
    sample.wallSeconds = 7;
    const passes::RaceFigures figures(repeats);
    EXPECT_FALSE(figures.deviceClock());
    EXPECT_EQ(figures.seconds(sample), 7);
}
