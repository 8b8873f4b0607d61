#include "engine/base/csv.h"

#include <gtest/gtest.h>

TEST(Csv, QuotesWhatNeedsIt)
{
    Csv csv({"a", "b"});
    csv.row({"1,5", "say \"x\""});
    csv.row({"plain", "two\nlines"});
    EXPECT_EQ(csv.text(), "a,b\n\"1,5\",\"say \"\"x\"\"\"\nplain,\"two\nlines\"\n");
}

TEST(Csv, NumbersReadBackExactly)
{
    for (const double value : {0.1, 1e-300, 1.0 / 3, -2.5e17}) EXPECT_EQ(std::stod(csvNumber(value)), value);
}
