// Error figures against closed forms on pictures of one color; SSIM against sums over each window in two dimensions;
// PSNR, SSIM and FLIP against other implementations (metrics_reference.py).
// Covers engine/image/plane.cpp.

#include "engine/image/metrics.h"

#include "engine/base/error.h"
#include "engine/image/flip.h"

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace
{

image::Image flat(uint32_t width, uint32_t height, glm::vec3 color)
{
    return {width, height, std::vector<glm::vec3>(size_t{width} * height, color)};
}

image::Image noisy(uint32_t seed, float noise)
{
    std::mt19937 random(seed);
    image::Image picture = flat(23, 17, glm::vec3(0));
    for (uint32_t y = 0; y < 17; ++y)
        for (uint32_t x = 0; x < 23; ++x)
            for (int c = 0; c < 3; ++c)
                picture.at(x, y)[c] = 1 + std::sin(0.3f * float(x) + float(c)) * std::cos(0.4f * float(y)) +
                                      noise * float(random() % 256);
    return picture;
}

double ssimByDefinition(const image::Image& a, const image::Image& b)
{
    const auto mapped = [](float v) { return double(v) / (1 + double(v)); };
    double total = 0, windows = 0;
    for (int c = 0; c < 3; ++c)
        for (int y = 5; y < int(a.height) - 5; ++y)
            for (int x = 5; x < int(a.width) - 5; ++x) {
                double weight = 0, ma = 0, mb = 0, va = 0, vb = 0, covariance = 0;
                for (int pass = 0; pass < 2; ++pass) {
                    weight = 0;
                    for (int j = -5; j <= 5; ++j)
                        for (int i = -5; i <= 5; ++i) {
                            const double w = std::exp(-(i * i + j * j) / 4.5);
                            const double p = mapped(a.at(uint32_t(x + i), uint32_t(y + j))[c]);
                            const double q = mapped(b.at(uint32_t(x + i), uint32_t(y + j))[c]);
                            weight += w;
                            if (pass == 0) {
                                ma += w * p;
                                mb += w * q;
                            } else {
                                va += w * (p - ma) * (p - ma);
                                vb += w * (q - mb) * (q - mb);
                                covariance += w * (p - ma) * (q - mb);
                            }
                        }
                    if (pass == 0) ma /= weight, mb /= weight;
                }
                va /= weight, vb /= weight, covariance /= weight;
                total +=
                    (2 * ma * mb + 1e-4) * (2 * covariance + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
                ++windows;
            }
    return total / windows;
}

// The pairs of metrics_reference.py, formula for formula.
using Color = std::function<double(int x, int y, int c)>;
constexpr int PAIR_WIDTH = 61, PAIR_HEIGHT = 47;

uint32_t hashed(int x, int y, int c, uint32_t seed)
{
    uint64_t h = uint64_t(x) * 73856093 ^ uint64_t(y) * 19349663 ^ uint64_t(c) * 83492791 ^ seed * uint64_t{2654435761};
    h = (h ^ h >> 13) * 1274126177;
    return uint32_t(h) >> 24;
}

double waves(int x, int y, int c)
{
    return 1 + std::sin(0.3 * x + c) * std::cos(0.2 * y);
}

double noisyWaves(int x, int y, int c)
{
    return waves(x, y, c) + hashed(x, y, c, 1) / 512.0;
}

double bars(int x, int y, int c)
{
    return (x / 7 + y / 5 + c) % 3 == 0 ? 4 : 0.0625;
}

double movedBars(int x, int y, int c)
{
    return bars(x + 1, y, c) * (c == 0 ? 1.25 : 1);
}

double lights(int x, int y, int c)
{
    return 0.25 + (hashed(x, y, 0, 3) > 250 ? 64 : 0) + (c == x * 3 / PAIR_WIDTH ? 0.5 : 0);
}

double dimmedLights(int x, int y, int c)
{
    return std::min(lights(x, y, 2 - c), 4.0);
}

image::Image picture(const Color& color)
{
    image::Image result = flat(PAIR_WIDTH, PAIR_HEIGHT, {});
    for (int y = 0; y < PAIR_HEIGHT; ++y)
        for (int x = 0; x < PAIR_WIDTH; ++x)
            for (int c = 0; c < 3; ++c) result.at(uint32_t(x), uint32_t(y))[c] = float(color(x, y, c));
    return result;
}

} // namespace

TEST(Metrics, AgreeWithOtherImplementationsOnThreePairs)
{
    const std::map<std::string, std::pair<Color, Color>> pairs = {
        {"noise on waves", {waves, noisyWaves}},
        {"bars moved by a pixel, reddened", {bars, movedBars}},
        {"lights gone, channels swapped", {lights, dimmedLights}}};
    std::ifstream file(TRICHROME_SOURCE_DIR "/tests/engine/image/metrics_reference.json");
    const nlohmann::json expected = nlohmann::json::parse(file);
    ASSERT_EQ(expected.size(), pairs.size());
    for (const auto& [name, pair] : pairs) {
        const image::Metrics m = image::measure(picture(pair.first), picture(pair.second));
        EXPECT_NEAR(m.psnr, expected[name]["psnr"].get<double>(), 1e-5) << name;
        EXPECT_NEAR(m.ssim, expected[name]["ssim"].get<double>(), 1e-6) << name;
        EXPECT_NEAR(m.flip, expected[name]["flip"].get<double>(), 1e-6) << name;
    }
}

TEST(Metrics, OfPicturesOfOneColorAreTheClosedForms)
{
    const image::Metrics m = image::measure(flat(13, 12, {1, 1, 1}), flat(13, 12, {3, 1, 1}));
    EXPECT_NEAR(m.mse, 4.0 / 3, 1e-12);
    EXPECT_NEAR(m.relmse, 4 / 1.01 / 3, 1e-12);
    EXPECT_NEAR(m.mape, 2 / 1.01 / 3, 1e-12);
    EXPECT_NEAR(m.psnr, -10 * std::log10(0.0625 / 3), 1e-12); // 3/4 against 1/2
    EXPECT_NEAR(m.ssim, ((2 * 0.75 * 0.5 + 1e-4) / (0.5625 + 0.25 + 1e-4) + 2) / 3, 1e-12);
    EXPECT_NEAR(m.lumaMse, 0.25, 1e-12);
    EXPECT_NEAR(m.chromaMse, 1 + 0.25, 1e-12);
    EXPECT_NEAR(m.meanRatio.r, 3, 1e-12);
    EXPECT_EQ(m.meanRatio.g, 1);
}

TEST(Metrics, OfEqualPicturesAreExact)
{
    for (const auto& picture : {noisy(1, 0.01f), flat(1, 1, {0, 0, 0}), flat(1, 40, {0.5f, 0, 2})}) {
        const image::Metrics m = image::measure(picture, picture);
        EXPECT_EQ(m.mse, 0);
        EXPECT_EQ(m.psnr, std::numeric_limits<double>::infinity());
        EXPECT_EQ(m.flip, 0);
        EXPECT_NEAR(m.ssim, 1, 1e-12);
        EXPECT_EQ(m.meanRatio, glm::dvec3(1));
    }
}

TEST(Metrics, SsimIsItsDefinitionOnThreePairs)
{
    for (const float noise : {0.0005f, 0.002f, 0.01f}) {
        const image::Image a = noisy(1, 0), b = noisy(2, noise);
        EXPECT_NEAR(image::measure(a, b).ssim, ssimByDefinition(a, b), 1e-9) << noise;
    }
}

// What the metric is made to be: 1 for the two colors that differ most, and the same whichever picture is first.
TEST(Metrics, FlipIsLargestForGreenAgainstBlue)
{
    const float white = std::numeric_limits<float>::max(); // c/(c+1) is 1
    EXPECT_NEAR(image::measure(flat(40, 30, {0, white, 0}), flat(40, 30, {0, 0, white})).flip, 1, 1e-6);
    EXPECT_LT(image::measure(flat(40, 30, {0, 0, 0}), flat(40, 30, {white, white, white})).flip, 0.99);
    EXPECT_EQ(image::measure(picture(bars), picture(movedBars)).flip,
              image::measure(picture(movedBars), picture(bars)).flip);
}

TEST(Metrics, FlipErrorsLieWhereThePicturesDiffer)
{
    image::Image changed = picture(waves);
    changed.at(30, 20) = {50, 0, 0};
    const image::Plane errors = image::flipErrors(picture(waves), changed);
    const auto most = std::max_element(errors.values.begin(), errors.values.end()) - errors.values.begin();
    EXPECT_EQ(most, 20 * PAIR_WIDTH + 30);
    EXPECT_EQ(errors.values[0], 0);
}

// A picture of negatives is as far from black as its mirror image, and not near that.
TEST(Metrics, ValuesBelowZeroCountAsMuchAsThoseAbove)
{
    const auto times = [](float factor, image::Image image) {
        for (glm::vec3& pixel : image.pixels) pixel *= factor;
        return image;
    };
    const image::Image black = flat(PAIR_WIDTH, PAIR_HEIGHT, {0, 0, 0}), light = picture(bars);
    const image::Image negative = times(-1, light);
    const image::Metrics above = image::measure(black, light), below = image::measure(black, negative),
                         apart = image::measure(light, negative);
    EXPECT_GT(above.flip, 0.3);
    EXPECT_EQ(above.flip, below.flip);
    EXPECT_EQ(above.psnr, below.psnr);
    EXPECT_EQ(above.ssim, below.ssim);
    EXPECT_NEAR(apart.psnr, above.psnr - 20 * std::log10(2), 1e-9);
    EXPECT_GT(apart.flip, 0.3);
    EXPECT_LT(apart.ssim, 0.01);
    EXPECT_EQ(image::measure(negative, negative).flip, 0);
    EXPECT_EQ(image::measure(negative, times(-1, picture(movedBars))).flip,
              image::measure(light, picture(movedBars)).flip);

    image::Image one = light; // of all values
    one.at(30, 20).g = -0.01f;
    EXPECT_GT(image::measure(light, one).flip, 0);
}

TEST(Metrics, RefuseOtherSizesAndValuesThatAreNotFinite)
{
    EXPECT_THROW(image::measure(flat(2, 3, {}), flat(3, 2, {})), Error);
    image::Image broken = flat(2, 3, {});
    broken.at(1, 2).g = std::numeric_limits<float>::infinity();
    EXPECT_THROW(image::measure(flat(2, 3, {}), broken), Error);
    EXPECT_THROW(image::measure(broken, flat(2, 3, {})), Error);
}
