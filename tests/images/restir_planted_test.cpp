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

struct PlantedError {
    const char* name;
    const char* file; // below shaders/
    const char* right;
    const char* wrong;
    RestirCase test;
};
void PrintTo(const PlantedError& error, std::ostream* os)
{
    *os << error.name;
}

const PlantedError ERRORS[] = {
    {"WeightTimes1_02",
     "restir/reservoir.glsl",
     "        here.weightSum = sum;\n",
     "        here.weightSum = 1.02 * sum;\n",
     {"Lambert", RgbRestir, Hybrid, Temporal, true, 8}},
    {"MissingJacobian",
     "path/integrand.glsl",
     "abs(dot(at.geometricNormal, direction)) / squared;",
     "abs(dot(at.geometricNormal, direction));",
     {"Room", RgbRestir, Hybrid, Temporal, true, 8}},
    {"MissingDensity",
     "path/trunk.glsl",
     "trunk.arrival * trunk.departure;",
     "trunk.arrival;",
     {"Room", RgbRestir, Hybrid, Temporal, true, 8}},
};

class RestirPlantedErrors : public GpuTest, public testing::WithParamInterface<PlantedError>
{
};

TEST_P(RestirPlantedErrors, AreFound)
{
    const PlantedError& error = GetParam();
    PlantedShaders shaders(error.name);
    ASSERT_NO_FATAL_FAILURE(shaders.plant(error.file, error.right, error.wrong));
    gpu::Device planted = openDevice({.shaderDirectory = shaders.folder().string()});
    const TileVerdict verdict = error.test.verdict(planted);
    EXPECT_FALSE(verdict.passes) << verdict.summary;
    std::printf("%s: %s\n", error.name, verdict.summary.c_str());
}

INSTANTIATE_TEST_SUITE_P(Of, RestirPlantedErrors, testing::ValuesIn(ERRORS),
                         [](const auto& i) { return i.param.name; });

} // namespace
} // namespace support
