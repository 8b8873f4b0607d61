#include "engine/scene/light_tables.h"

#include <bit>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace scene
{
namespace
{

constexpr long double PI = std::numbers::pi_v<long double>;

// The probability that drawing from the environment's alias table gives each texel.
std::vector<double> drawn(const LightTables& tables, size_t count)
{
    std::vector<double> result(count, 0);
    for (size_t i = 0; i < count; ++i) {
        const glm::uvec4& pair = tables.environmentAliases[i / 2];
        const double threshold = double{std::bit_cast<float>(i % 2 ? pair.z : pair.x)};
        result[i] += threshold / double(count);
        result[i % 2 ? pair.w : pair.y] += (1 - threshold) / double(count);
    }
    return result;
}

// The density that shaders read is the probability of the texel over its solid angle, and that probability is drawn.
TEST(LightTables, DensityOfTheSkyIsThatOfDrawingIt)
{
    std::mt19937 engine(1);
    std::lognormal_distribution<float> wide(0, 2);
    for (const auto& [columns, rows] : {std::pair(2u, 1u), {7u, 5u}, {128u, 64u}, {2048u, 1024u}, {64u, 4096u}}) {
        Scene scene;
        scene.environment = {columns, rows, {}};
        const size_t count = size_t{columns} * rows;
        for (size_t i = 0; i < count; ++i)
            scene.environment.radiance.emplace_back(i % 5 ? wide(engine) : 0.0f, wide(engine),
                                                    i % 3 ? 0 : wide(engine));
        scene.environment.radiance[count / 2] = glm::vec3(1e5f);
        scene.environment.radiance[count / 3] = glm::vec3(0);
        const LightTables tables = makeLightTables(scene, {}, 1, 1);
        ASSERT_EQ(tables.environment.size(), count);
        ASSERT_EQ(tables.environmentPick, 1);
        const std::vector<double> probabilities = drawn(tables, count);
        for (uint32_t row = 0; row < rows; ++row) {
            const long double band = std::cos(PI * row / rows) - std::cos(PI * (row + 1) / rows);
            for (uint32_t column = 0; column < columns; ++column) {
                const size_t i = size_t{row} * columns + column;
                const double claimed =
                    double{std::bit_cast<float>(tables.environment[i].w)} * double(2 * PI / columns * band);
                // A threshold's rounding is a part of one entry.
                ASSERT_NEAR(probabilities[i], claimed, 1e-6 * std::max(claimed, 1 / double(count)))
                    << column << ", " << row << " of " << columns << " x " << rows;
            }
        }
        EXPECT_EQ(probabilities[count / 3], 0);
    }
}

// Radiance times solid angle, by the largest channel.
TEST(LightTables, SkyIsDrawnByPower)
{
    Scene scene;
    scene.environment = {1, 4, {{1, 0, 0}, {0, 2, 1}, {0, 0, 0}, {3, 3, 0}}};
    const std::vector<double> probabilities = drawn(makeLightTables(scene, {}, 1, 1), 4);
    const double cap = 1 - std::sqrt(0.5), sum = cap * (1 + 3) + 2 * std::sqrt(0.5);
    EXPECT_NEAR(probabilities[0], cap / sum, 1e-6);
    EXPECT_NEAR(probabilities[1], 2 * std::sqrt(0.5) / sum, 1e-6);
    EXPECT_EQ(probabilities[2], 0);
    EXPECT_NEAR(probabilities[3], 3 * cap / sum, 1e-6);
}

// A spot counts by its cone: between two of one intensity, one of 45 degrees and one as narrow as float32 lets it be.
TEST(LightTables, NarrowSpotsCountByTheirSolidAngle)
{
    for (const double angle : {10.0, 1.0, 0.1, 0.01, 0.001}) {
        Scene scene;
        const auto outer = float(angle * double(PI) / 180);
        scene.lights.push_back({.kind = LightKind::Spot, .intensity = glm::vec3(1), .outerConeAngle = 0.75f});
        scene.lights.push_back({.kind = LightKind::Spot,
                                .intensity = glm::vec3(1),
                                .innerConeAngle = 0.5f * outer,
                                .outerConeAngle = outer});
        const LightTables tables = makeLightTables(scene, {}, 1, 1);
        const long double narrow = 1 - std::cos((long double){outer}), wide = 1 - std::cos((long double){0.75f});
        const double expected = double(narrow / (narrow + wide));
        EXPECT_NEAR(double{std::bit_cast<float>(tables.lights[1].z)}, expected, 1e-6 * expected) << angle;
    }
}

} // namespace
} // namespace scene
