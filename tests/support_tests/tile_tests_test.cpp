#include "tests/support/tile_tests.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace support
{
namespace
{

// Runs of a 20x13 picture (ragged tiles): a gradient with skewed noise of 10% a pixel; one tile can be made wrong.
class Synthetic
{
  public:
    explicit Synthetic(uint64_t seed) : random_(seed) {}

    image::Image run(float factor = 1)
    {
        image::Image picture{20, 13, std::vector<glm::vec3>(size_t{20} * 13)};
        std::gamma_distribution<float> noise(100.0f, 0.01f);
        for (uint32_t y = 0; y < 13; ++y)
            for (uint32_t x = 0; x < 20; ++x) {
                const float truth = 1 + 0.1f * static_cast<float>(x + y);
                const bool planted = x >= 8 && x < 16 && y < 8; // tile (1, 0), green only
                picture.at(x, y) =
                    truth * glm::vec3(noise(random_), noise(random_) * (planted ? factor : 1), noise(random_));
            }
        return picture;
    }

    TileEstimates runs(int count, float factor = 1)
    {
        TileRuns result;
        for (int i = 0; i < count; ++i) result.add(run(factor));
        return result.estimates();
    }

    // The same as a picture of independent pixels.
    PixelEstimates pixels(int count)
    {
        std::vector<std::array<Moments, 3>> moments(size_t{20} * 13);
        for (int i = 0; i < count; ++i) {
            const image::Image picture = run();
            for (size_t p = 0; p < moments.size(); ++p)
                for (int c = 0; c < 3; ++c) moments[p][static_cast<size_t>(c)].add(picture.pixels[p][c]);
        }
        PixelEstimates result{20, 13, {}};
        for (const auto& m : moments) result.pixels.push_back({estimateOf(m[0]), estimateOf(m[1]), estimateOf(m[2])});
        return result;
    }

  private:
    std::mt19937_64 random_;
};

TEST(Equivalence, IsRarelyShownAtTheMarginAndOftenShownWithinIt)
{
    std::mt19937_64 random(4);
    const int trials = 5000;
    const auto shown = [&](double difference) {
        std::normal_distribution<double> left(1 + difference, 0.02), right(1, 0.02);
        int count = 0;
        for (int trial = 0; trial < trials; ++trial) {
            Moments a, b;
            for (int i = 0; i < 100; ++i) {
                a.add(left(random));
                b.add(right(random));
            }
            count += showsEquivalence(statistics::compare(estimateOf(a), estimateOf(b)), 0.01, 0.05);
        }
        return count;
    };
    const double spread = 4.9 * std::sqrt(0.05 * 0.95 * trials); // exceeded with probability 1e-6
    EXPECT_NEAR(shown(0.01), 0.05 * trials, spread);
    EXPECT_NEAR(shown(-0.01), 0.05 * trials, spread);
    EXPECT_GT(shown(0), 0.9 * trials);
    EXPECT_LT(shown(0.02), 3);
}

TEST(TileTests, DisagreeByChanceAtTheStatedLevelOnly)
{
    Synthetic synthetic(1);
    const int trials = 1500;
    int rejectedRuns = 0, rejectedPixels = 0;
    for (int trial = 0; trial < trials; ++trial) {
        const TileEstimates reference = tilesOf(synthetic.pixels(8));
        rejectedRuns += !tilesAgree(synthetic.runs(8), synthetic.runs(5), 0.05).passes;
        rejectedPixels += !tilesAgree(reference, synthetic.runs(8), 0.05).passes;
    }
    const double tolerance = 4.9 * std::sqrt(0.05 * 0.95 / trials);
    EXPECT_NEAR(rejectedRuns / double{trials}, 0.05, tolerance);
    EXPECT_NEAR(rejectedPixels / double{trials}, 0.05, tolerance);
}

TEST(TileTests, RejectAPlantedErrorOfTwoPercentInOneTileAndChannel)
{
    Synthetic synthetic(2);
    const TileEstimates reference = tilesOf(synthetic.pixels(200));
    const TileVerdict honest = tilesAgree(synthetic.runs(200), reference);
    EXPECT_TRUE(honest.passes) << honest.summary;
    const TileVerdict planted = tilesAgree(synthetic.runs(200, 1.02f), reference);
    EXPECT_FALSE(planted.passes);
    EXPECT_NE(planted.summary.find("tile (1, 0) of 3x2, channel 1"), std::string::npos) << planted.summary;
}

TEST(TileTests, ShowEquivalenceOnlyWithinTheMarginAndWithEnoughRuns)
{
    Synthetic synthetic(3);
    const TileEstimates reference = synthetic.runs(400);
    const TileVerdict honest = tilesAreEquivalent(synthetic.runs(400), reference);
    EXPECT_TRUE(honest.passes) << honest.summary;
    EXPECT_FALSE(tilesAreEquivalent(synthetic.runs(4), reference).passes) << "four runs show nothing";
    const TileVerdict planted = tilesAreEquivalent(synthetic.runs(400, 1.02f), reference, 0.01);
    EXPECT_FALSE(planted.passes);
    EXPECT_NE(planted.summary.find("tile (1, 0) of 3x2, channel 1"), std::string::npos) << planted.summary;
}

TEST(TileTests, RejectValuesThatAreNotNumbers)
{
    Synthetic synthetic(4);
    const TileEstimates reference = synthetic.runs(10);
    TileEstimates broken = reference;
    broken.tiles[2][0].mean = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(tilesAgree(broken, reference).passes);
    EXPECT_FALSE(tilesAreEquivalent(broken, reference, 1e3).passes);
}

} // namespace
} // namespace support
