#pragma once
// Constant-time sampling of a discrete distribution. Vose, "A Linear Algorithm for Generating Random Numbers with a
// Given Distribution", 1991.

#include <cstdint>
#include <span>
#include <vector>

namespace scene
{

struct AliasEntry {
    float threshold = 1; // draw an entry uniformly; keep it with this probability, else take `alias`
    uint32_t alias = 0;
    float probability = 0; // of the outcome: weight / sum of weights
};

// Weights are finite and >= 0. All-zero weights give probability 0 everywhere (nothing may be sampled from it).
std::vector<AliasEntry> buildAliasTable(std::span<const double> weights);

} // namespace scene
