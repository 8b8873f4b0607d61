// Would the agreement tests notice? Each of these errors, planted in the shaders' text and compiled at run time, must
// be found. More of them, in resampling itself, are planted in tests/shaders/toy.

#include <gtest/gtest.h>

#include "tests/support/gpu_fixture.h"
#include "tests/support/planted_shaders.h"
#include "tests/support/restir_cases.h"

namespace support
{
namespace
{

using enum passes::Method;
using enum passes::Shift;
using enum Reuse;

struct RestirError {
    const char* name; // of plantedErrors()
    RestirCase test;
};
void PrintTo(const RestirError& error, std::ostream* os)
{
    *os << error.name;
}

const RestirError ERRORS[] = {
    {"WeightTimes1_02", {"Lambert", RgbRestir, Hybrid, Temporal, true, 8}},
    {"MissingGeometryTerm", {"Room", RgbRestir, Hybrid, Temporal, true, 8}},
    {"MissingDeparture", {"Room", RgbRestir, Hybrid, Temporal, true, 8}},
    {"MutationWithoutDensities",
     {"Room", RestirPt, Reconnection, Both, false, 64, 400, 12, passes::Color::Chosen, passes::Mutate::Free}},
    {"MutationByTheDensityElsewhere",
     {"Room", RestirPt, Reconnection, Both, false, 64, 400, 12, passes::Color::Chosen, passes::Mutate::Free}},
    {"MutationForgetsTheDensityInSpace",
     {"Room", RestirPt, Reconnection, Both, false, 64, 400, 12, passes::Color::Chosen, passes::Mutate::Free}},
    {"MutationForgetsTheDensityInTime",
     {"Room", RestirPt, Reconnection, Temporal, true, 64, 1000, 6, passes::Color::Chosen, passes::Mutate::Free}},
    // Where the scene moves.
    {"PreviousWorldForgotten", {"LampChanges", RgbRestir, Hybrid, Temporal, false, 64, 200, 5}},
    {"StaleSuffix", {"CeilingLit", RgbRestir, Hybrid, Both, false, 64, 500, 5}},
    {"StretchingForgotten", {"WallStretches", RgbRestir, Hybrid, Temporal, false, 64, 300}},
};

class RestirPlantedErrors : public GpuTest, public testing::WithParamInterface<RestirError>
{
};

TEST_P(RestirPlantedErrors, AreFound)
{
    const RestirError& error = GetParam();
    PlantedShaders shaders(error.name);
    shaders.plant(plantedError(error.name));
    gpu::Device planted = openDevice({.shaderDirectory = shaders.folder().string()});
    const TileVerdict verdict = error.test.verdict(planted);
    EXPECT_FALSE(verdict.passes) << verdict.summary;
    std::printf("%s: %s\n", error.name, verdict.summary.c_str());
}

INSTANTIATE_TEST_SUITE_P(Of, RestirPlantedErrors, testing::ValuesIn(ERRORS),
                         [](const auto& i) { return i.param.name; });

} // namespace
} // namespace support
