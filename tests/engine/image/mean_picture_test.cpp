// The error of a reference, and errors against it, where the truth is known.

#include "engine/image/mean_picture.h"

#include "engine/base/statistics.h"

#include <random>

#include <gtest/gtest.h>

namespace
{

constexpr uint32_t WIDTH = 24, HEIGHT = 16;

glm::dvec3 truthAt(uint32_t x, uint32_t y)
{
    return {0.1 + 0.05 * x, 0.7, 0.02 * y};
}

image::Image truth()
{
    image::Image picture{.width = WIDTH, .height = HEIGHT};
    for (uint32_t y = 0; y < HEIGHT; ++y)
        for (uint32_t x = 0; x < WIDTH; ++x) picture.pixels.emplace_back(truthAt(x, y));
    return picture;
}

// Standard deviations of the channels.
constexpr glm::dvec3 NOISE = {0.3, 0.1, 0.2};

image::Image noisy(std::mt19937_64& random)
{
    std::normal_distribution<double> gaussian;
    image::Image picture = truth();
    for (glm::vec3& pixel : picture.pixels)
        for (int c = 0; c < 3; ++c) pixel[c] += float(NOISE[c] * gaussian(random));
    return picture;
}

image::MeanPicture meanOf(std::mt19937_64& random, int count)
{
    image::MeanPicture mean;
    for (int i = 0; i < count; ++i) mean.add(noisy(random));
    return mean;
}

void expectNear(double value, double expected, double relative, const char* what)
{
    EXPECT_NEAR(value, expected, relative * expected) << what;
}

} // namespace

TEST(MeanPicture, IsTheMeanAndKnowsItsVariance)
{
    image::MeanPicture mean;
    mean.add({1, 1, {{1, 2, 3}}});
    mean.add({1, 1, {{3, 2, 0}}});
    mean.add({1, 1, {{5, 2, 0}}});
    EXPECT_EQ(mean.mean().pixels[0], glm::vec3(3, 2, 1));
    // Variances of the channels: 4, 0, 3; a third of them for the mean of three.
    const image::OwnError error = mean.ownError();
    EXPECT_NEAR(error.mse, (4 + 0 + 3) / 9.0, 1e-14);
    EXPECT_NEAR(error.relmse, (4 / 9.01 + 0 + 3 / 1.01) / 9, 1e-14);
    // Y = 2, 1.75, 2.25; Co = -1, 1.5, 2.5; Cg = 0, 0.25, -0.25.
    EXPECT_NEAR(error.lumaMse, 0.0625 / 3, 1e-14);
    EXPECT_NEAR(error.chromaMse, (3.25 + 0.0625) / 3, 1e-14);
}

TEST(MeanPicture, EstimatesTheErrorThatItHas)
{
    std::mt19937_64 random(1);
    image::OwnError estimated, real;
    constexpr int TRIALS = 200;
    for (int i = 0; i < TRIALS; ++i) {
        const image::MeanPicture mean = meanOf(random, 16);
        const image::OwnError e = mean.ownError();
        const image::Metrics m = image::measure(truth(), mean.mean());
        estimated = {estimated.mse + e.mse, 0, estimated.lumaMse + e.lumaMse, estimated.chromaMse + e.chromaMse};
        real = {real.mse + m.mse, 0, real.lumaMse + m.lumaMse, real.chromaMse + m.chromaMse};
    }
    const double closed = glm::dot(NOISE, NOISE) / 3 / 16; // the law of means
    expectNear(estimated.mse / TRIALS, closed, 0.01, "mse");
    expectNear(real.mse / TRIALS, closed, 0.01, "mse");
    expectNear(estimated.lumaMse, real.lumaMse, 0.02, "luma");
    expectNear(estimated.chromaMse, real.chromaMse, 0.02, "chroma");
}

// Against a reference as noisy as what is measured: without the subtraction all figures would be twice too large.
TEST(MeanPicture, ErrorsWithoutTheReferencesOwnAreThoseAgainstTheTruth)
{
    std::mt19937_64 random(2);
    statistics::Moments mse, luma, chroma, relmse;
    for (int i = 0; i < 300; ++i) {
        const image::MeanPicture reference = meanOf(random, 4), picture = meanOf(random, 4);
        const image::Metrics error =
            image::without(reference.ownError(), image::measure(reference.mean(), picture.mean()));
        mse.add(error.mse);
        luma.add(error.lumaMse);
        chroma.add(error.chromaMse);
        relmse.add(error.relmse);
    }
    const glm::dvec3 v = NOISE * NOISE / 4.0;
    const auto expectMean = [](const statistics::Moments& m, double expected, const char* what) {
        EXPECT_NEAR(m.mean(), expected, 4 * std::sqrt(m.varianceOfMean())) << what;
        EXPECT_LT(std::sqrt(m.varianceOfMean()), 0.01 * expected) << what; // so that 4% would be seen
    };
    expectMean(mse, (v.r + v.g + v.b) / 3, "mse");
    expectMean(luma, v.r / 16 + v.g / 4 + v.b / 16, "luma");
    expectMean(chroma, (v.r + v.b) / 4 + v.g / 4 + (v.r + v.b) / 16, "chroma");
    // The relative weights are the noisy reference's: near the closed form with the truth's.
    double closed = 0;
    for (uint32_t y = 0; y < HEIGHT; ++y)
        for (uint32_t x = 0; x < WIDTH; ++x)
            for (int c = 0; c < 3; ++c) {
                const double r = truthAt(x, y)[c];
                closed += v[c] / (r * r + image::RELATIVE_EPSILON) / (3 * WIDTH * HEIGHT);
            }
    EXPECT_NEAR(relmse.mean(), closed, 0.35 * closed);
}

TEST(MeanPicture, FiguresMayFallBelowZeroAndAreNotCutOff)
{
    const image::Metrics error = image::without({.mse = 1, .relmse = 2, .lumaMse = 3, .chromaMse = 4}, {});
    EXPECT_EQ(error.mse, -1);
    EXPECT_EQ(error.relmse, -2);
    EXPECT_EQ(error.lumaMse, -3);
    EXPECT_EQ(error.chromaMse, -4);
}
