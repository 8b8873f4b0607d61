// Would the agreement tests notice? Each of these errors, planted in the shaders' text and compiled at run time, must
// be found.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/support/gpu_fixture.h"
#include "tests/support/restir_cases.h"

namespace support
{
namespace
{

namespace fs = std::filesystem;
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
    {"SwappedTemporalMis",
     "restir/reservoir.glsl",
     "here.weightSum * rest(historyConfidence, rho, confidence);",
     "here.weightSum * rest(confidence, rho, historyConfidence);",
     {"Lambert", RgbRestir, Replay, Temporal, true, 8}},
    {"SwappedSpatialMis",
     "spatial_gather.comp",
     "part * share(neighborConfidence, words.w, confidence);",
     "part * share(confidence, words.w, neighborConfidence);",
     {"Lambert", RgbRestir, Replay, Spatial, false, 8}},
    {"SpatialConfidenceOffByOne",
     "spatial_gather.comp",
     "share(confidence, a, neighborConfidence);",
     "share(confidence, a, neighborConfidence + 1.0);",
     {"Lambert", RgbRestir, Replay, Spatial, false, 8}},
    {"StaleTarget",
     "temporal.comp",
     "r[c].f = fHere[c];",
     "r[c].f = old[c].f;",
     {"Lambert", RgbRestir, Replay, Temporal, true, 64}},
    {"EmptyHistoryForgotten",
     "temporal.comp",
     "if (historyConfidence == 0u ||",
     "if (loadHistoryHead(previousPixel, 0u).weightSum == 0.0 || historyConfidence == 0u ||",
     {"ManyLamps", RgbRestir, Replay, Temporal, true, 64}},
};

std::string textOf(const fs::path& path)
{
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

class RestirPlantedErrors : public GpuTest, public testing::WithParamInterface<PlantedError>
{
};

TEST_P(RestirPlantedErrors, AreFound)
{
    const PlantedError& error = GetParam();
    const fs::path folder = fs::path(testing::TempDir()) / ("planted_" + std::string(error.name));
    fs::remove_all(folder);
    fs::copy(TRICHROME_SOURCE_DIR "/shaders", folder, fs::copy_options::recursive);
    std::string text = textOf(folder / error.file);
    const size_t at = text.find(error.right);
    ASSERT_NE(at, std::string::npos) << "the text to replace is gone from " << error.file;
    text.replace(at, std::string(error.right).size(), error.wrong);
    std::ofstream(folder / error.file) << text;

    gpu::Device planted = openDevice({.shaderDirectory = folder.string()});
    const TileVerdict verdict = error.test.verdict(planted);
    EXPECT_FALSE(verdict.passes) << verdict.summary;
    std::printf("%s: %s\n", error.name, verdict.summary.c_str());
    fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Of, RestirPlantedErrors, testing::ValuesIn(ERRORS),
                         [](const auto& i) { return i.param.name; });

} // namespace
} // namespace support
