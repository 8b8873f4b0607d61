#include "ui/cli/progress.h"

#include <gtest/gtest.h>

TEST(Progress, TellsShareCountRateAndTimeLeft)
{
    EXPECT_EQ(ui::progressText(16, 64, 8, "frames"), "25%  16/64 frames  2 frames/s  24 s left");
    EXPECT_EQ(ui::progressText(0.5, 1, 90, ""), "50%  1 min 30 s left");
    EXPECT_EQ(ui::progressText(1, 11, 1000, ""), "9%  2 h 46 min left");
    EXPECT_EQ(ui::progressText(0, 64, 0, "frames"), "0%  0/64 frames"); // nothing to go by yet
    EXPECT_EQ(ui::progressText(5, 0, 2, "runs"), "5 runs  2.5 runs/s"); // no end in sight
    EXPECT_EQ(ui::progressText(3, 2, 6, ""), "100%  0 s left");         // by time, the last frame ends late
}
