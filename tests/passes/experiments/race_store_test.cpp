// Repeats on disk.

#include "passes/experiments/race_store.h"

#include "engine/base/error.h"
#include "tests/passes/experiments/repeats.h"
#include "tests/support/program.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

using passes::RaceStore;
using support::repeatOf;

TEST(RaceStore, GivesBackWhatWasFinished)
{
    const TemporaryDirectory directory;
    const RaceStore store(directory / "out", "key", {"pt", "rgb-restir:spatial=0"});
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
    EXPECT_NO_THROW(RaceStore(directory / "elsewhere", "key", {"pt"}).requireNew());
}

TEST(RaceStore, RefusesOtherSettingsAndDamage)
{
    const TemporaryDirectory directory;
    const std::string out = directory / "out";
    const RaceStore store(out, "key", {"pt", "b"});
    store.write(1, repeatOf(1, 1, false));
    EXPECT_TRUE(store.read(9).empty()); // the first is missing
    passes::Repeat repeat = repeatOf(1, 1, false);
    repeat.finals.assign(2, {.width = 1, .height = 1, .pixels = {{0, 0, 0}}});
    store.write(0, repeat);
    EXPECT_THROW(RaceStore(out, "other", {"pt", "b"}).read(9), Error);
    EXPECT_THROW(RaceStore(out, "key", {"pt"}).read(9), Error); // a method that there is not
    for (const char* damaged : {"", "{", "{}", R"({"key": "key", "nonfinite": 0, "samples": [[0, true, 1]]})"}) {
        writeFile(out + "/repeats/0000.json", damaged);
        EXPECT_THROW(store.read(9), Error) << damaged;
    }
}
