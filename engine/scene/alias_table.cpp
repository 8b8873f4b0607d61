#include "engine/scene/alias_table.h"

#include "engine/base/check.h"

#include <cmath>

namespace scene
{

std::vector<AliasEntry> buildAliasTable(std::span<const double> weights)
{
    const size_t count = weights.size();
    std::vector<AliasEntry> table(count);
    // The largest weight is divided out first, so that neither the sum nor a product overflows.
    double largest = 0;
    for (const double weight : weights) {
        CHECK(std::isfinite(weight) && weight >= 0);
        largest = std::max(largest, weight);
    }
    double sum = 0;
    if (largest > 0)
        for (const double weight : weights) sum += weight / largest;

    std::vector<double> share(count); // of the mean: 1 fills one entry
    std::vector<uint32_t> small, large;
    for (size_t i = 0; i < count; ++i) {
        const double probability = sum > 0 ? weights[i] / largest / sum : 0;
        table[i] = {.threshold = 1, .alias = uint32_t(i), .probability = float(probability)};
        share[i] = probability * double(count);
        (share[i] < 1 ? small : large).push_back(uint32_t(i));
    }
    while (!small.empty() && !large.empty()) {
        const uint32_t poor = small.back(), rich = large.back();
        small.pop_back();
        table[poor].threshold = float(share[poor]);
        table[poor].alias = rich;
        share[rich] -= 1 - share[poor];
        if (share[rich] < 1) {
            large.pop_back();
            small.push_back(rich);
        }
    }
    return table; // what is left over is 1 up to rounding
}

} // namespace scene
