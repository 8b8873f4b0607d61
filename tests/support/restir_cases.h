#pragma once
// What to ask of ReSTIR's unbiasedness: a covering choice of scene, estimator, shift map, reuse, M_c and motion.

#include <ostream>
#include <string>
#include <vector>

#include "engine/gpu/gpu.h"
#include "passes/settings.h"
#include "tests/support/tile_tests.h"

namespace support
{

enum class Reuse { Temporal, Spatial, Both };

struct RestirCase {
    const char* scene; // of testScenes() or movingWorlds()
    passes::Method method;
    passes::Shift shift;
    Reuse reuse;
    bool moves; // the camera turns by 3 degrees a frame
    uint32_t maxConfidence;
    uint32_t runs = 200; // at most: fewer where fewer tell
    uint32_t frames = 5;
    passes::Color color = passes::Color::Weighted;
    passes::Mutate mutate = passes::Mutate::Off;
    double level = 1e-3; // how often what is unbiased may seem biased
    uint64_t seed = 1000;

    std::string name() const;
    // The last frame, its mean over many runs, against the path tracer's picture from the same place.
    TileVerdict verdict(gpu::Device& device) const;
};
void PrintTo(const RestirCase& c, std::ostream* os);

// Each at its share of a level for all of them, and with numbers of its own.
std::vector<RestirCase> asFamily(std::vector<RestirCase> cases, double level = 1e-3);

// With TRICHROME_TEST_MATRIX set: the whole product, in one scene.
std::vector<RestirCase> restirCases();

} // namespace support
