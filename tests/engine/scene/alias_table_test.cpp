#include "engine/scene/alias_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace scene
{
namespace
{

// The probabilities that drawing from the table gives.
std::vector<double> drawn(const std::vector<AliasEntry>& table)
{
    std::vector<double> result(table.size(), 0);
    for (size_t i = 0; i < table.size(); ++i) {
        result[i] += double{table[i].threshold} / double(table.size());
        result[table[i].alias] += (1 - double{table[i].threshold}) / double(table.size());
    }
    return result;
}

void expectFaithful(const std::vector<double>& weights)
{
    const std::vector<AliasEntry> table = buildAliasTable(weights);
    ASSERT_EQ(table.size(), weights.size());
    const std::vector<double> probabilities = drawn(table);
    const double largest = *std::max_element(weights.begin(), weights.end());
    double sum = 0;
    for (const double weight : weights) sum += weight / largest;
    for (size_t i = 0; i < weights.size(); ++i) {
        const double exact = weights[i] / largest / sum;
        EXPECT_NEAR(table[i].probability, exact, 1e-7 * exact + double{std::numeric_limits<float>::denorm_min()}) << i;
        // Thresholds are float32: each of an entry's shares is rounded by 2^-24 of an entry at most.
        EXPECT_NEAR(probabilities[i], exact, 1e-6 * std::max(exact, 1.0 / double(weights.size()))) << i;
        EXPECT_TRUE(table[i].threshold >= 0 && table[i].threshold <= 1) << i;
        if (weights[i] == 0) {
            EXPECT_EQ(probabilities[i], 0) << i;
        }
    }
}

TEST(AliasTable, DrawsByWeight)
{
    expectFaithful({1});
    expectFaithful({1, 1, 1, 1});
    expectFaithful({1, 2, 3, 4, 5});
    expectFaithful({0, 1, 0, 3, 0});
    expectFaithful({1e-20, 1, 1e20});
    std::mt19937_64 engine(1);
    std::lognormal_distribution<double> wide(0, 3);
    std::vector<double> weights(10007);
    for (double& weight : weights) weight = wide(engine);
    expectFaithful(weights);
}

TEST(AliasTable, StandsExtremeWeights)
{
    const double huge = std::numeric_limits<double>::max(), tiny = std::numeric_limits<double>::denorm_min();
    expectFaithful({huge, huge, huge});
    expectFaithful({huge, huge / 3, 1});
    expectFaithful({tiny, tiny});
}

TEST(AliasTable, OfNothingGivesNothing)
{
    EXPECT_TRUE(buildAliasTable({}).empty());
    for (const AliasEntry& entry : buildAliasTable(std::vector<double>{0, 0, 0})) EXPECT_EQ(entry.probability, 0);
}

} // namespace
} // namespace scene
