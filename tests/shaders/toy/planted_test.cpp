// Would the toy notice? Each of these errors, planted in the real stages' text and compiled at run time, must be found.

#include <filesystem>

#include "tests/support/gpu_fixture.h"
#include "tests/support/planted_shaders.h"
#include "tests/support/toy_world.h"

namespace support
{
namespace
{

using enum Reuse;
using passes::Shift;

struct ToyError {
    const char* name;
    const char* file; // below shaders/
    const char* right;
    const char* wrong;
    Shift shift;
    ToyCase test;
    uint32_t runs = 256;
    passes::Method method = passes::Method::RgbRestir;
    passes::Color color = passes::Color::Chosen;
};
void PrintTo(const ToyError& error, std::ostream* os)
{
    *os << error.name;
}

const ToyError ERRORS[] = {
    {"WeightTimes1_02",
     "restir/reservoir.glsl",
     "        here.weightSum = sum;\n",
     "        here.weightSum = 1.02 * sum;\n",
     Shift::Replay,
     {Temporal, true, 8}},
    {"MissingJacobian",
     "canonical.comp",
     "finiteOrCounted(f * density, STAGE)",
     "f",
     Shift::Hybrid,
     {Temporal, true, 1},
     1024},
    {"SwappedTemporalMis",
     "restir/reservoir.glsl",
     "here.weightSum * rest(historyConfidence, rho, confidence);",
     "here.weightSum * rest(confidence, rho, historyConfidence);",
     Shift::Replay,
     {Temporal, true, 8}},
    {"SwappedSpatialMis",
     "spatial_gather.comp",
     "part * share(neighborConfidence, b, confidence);",
     "part * share(confidence, b, neighborConfidence);",
     Shift::Replay,
     {Spatial, false, 8}},
    {"TemporalConfidenceOffByOne",
     "restir/reservoir.glsl",
     "here.weightSum * rest(historyConfidence, rho, confidence);",
     "here.weightSum * rest(historyConfidence + 1.0, rho, confidence);",
     Shift::Hybrid,
     {Temporal, true, 8}},
    {"SpatialConfidenceOffByOne",
     "spatial_gather.comp",
     "share(confidence, a, neighborConfidence);",
     "share(confidence, a, neighborConfidence + 1.0);",
     Shift::Hybrid,
     {Spatial, true, 8}},
    {"StaleTarget", "temporal.comp", "r[c].f = fHere[c];", "r[c].f = old[c].f;", Shift::Replay, {Temporal, true, 64}},
    {"EmptyHistoryForgotten",
     "temporal.comp",
     "if (historyConfidence == 0u ||",
     "if (loadHistoryHead(previousPixel, 0u).weightSum == 0.0 || historyConfidence == 0u ||",
     Shift::Replay,
     {Temporal, true, 64}},
    {"FailedShiftForgotten",
     "restir/reservoir.glsl",
     "        here.weightSum = weight;\n",
     "",
     Shift::Hybrid,
     {Temporal, true, 8}},
    {"LuminanceWeights",
     "temporal.comp",
     "ratio(targetOf(c, fThere[c]), targetOf(c, r[c].f))",
     "ratio(dot(vec3(1.0), fThere[c]), dot(vec3(1.0), r[c].f))",
     Shift::Replay,
     {Temporal, true, 8}},
    {"NeighborsByContent",
     "spatial_gather.comp",
     "chosenBy(neighbor, slot) == pixel ?",
     "chosenBy(neighbor, slot) == pixel && loadReservoirsHead(neighbor, 0u).weightSum > 0.0 ?",
     Shift::Replay,
     {Spatial, false, 8}},
    {"PathOfAnother",
     "spatial_gather.comp",
     "loadReservoirsPath(lender[c], c)",
     "loadReservoirsPath(pixel, c)",
     Shift::Hybrid,
     {Both, true, 64}},
    // What weighted color alone shows: reservoirs stay right.
    {"ColorOfOwnWeightTimes1_02",
     "temporal.comp",
     "color += weight * colorOf",
     "color += 1.02 * weight * colorOf",
     Shift::Replay,
     {Temporal, true, 1},
     1024,
     passes::Method::RestirPt,
     passes::Color::Weighted},
    {"ColorBySwappedTemporalWeights",
     "temporal.comp",
     "color += weight * colorOf(c, r[c].f) + historyWeight * colorOf(c, fHere[c]);",
     "color += historyWeight * colorOf(c, r[c].f) + weight * colorOf(c, fHere[c]);",
     Shift::Replay,
     {Temporal, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Weighted},
    {"ColorFromTheHistorysDomain",
     "temporal.comp",
     "historyWeight * colorOf(c, fHere[c])",
     "historyWeight * colorOf(c, old[c].f)",
     Shift::Replay,
     {Temporal, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Weighted},
    {"ColorFromTheNeighborsDomain",
     "spatial_gather.comp",
     "weighted += weight * colorOf(c, fHere);",
     "weighted += weight * colorOf(c, other.f);",
     Shift::Hybrid,
     {Spatial, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Weighted},
    {"ColorByTheOwnMisWeight",
     "spatial_gather.comp",
     "weighted += weight * colorOf(c, fHere);",
     "weighted += taken * (other.weightSum + other.carry) * colorOf(c, fHere);",
     Shift::Hybrid,
     {Spatial, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Weighted},
    {"ColorOfTheOwnSampleWhole",
     "spatial_gather.comp",
     "(r[c].weightSum * kept[c] + r[c].carry)",
     "(r[c].weightSum + r[c].carry)",
     Shift::Hybrid,
     {Spatial, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Weighted},
    {"ColorOfAKeptShare2PercentTooLarge",
     "spatial_gather.comp",
     "(r[c].weightSum * kept[c] + r[c].carry)",
     "(r[c].weightSum * (kept[c] + 0.04 * (1.0 - kept[c])) + r[c].carry)",
     Shift::Hybrid,
     {Spatial, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Weighted},
    {"ColorOfTheFirstLeafTwice",
     "canonical.comp",
     "allPaths += f;",
     "allPaths += canonical[0].weightSum > 0.0 ? f : 2.0 * f;",
     Shift::Hybrid,
     {Temporal, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Weighted},
};

class ToyPlantedErrors : public GpuTest, public testing::WithParamInterface<ToyError>
{
};

TEST_P(ToyPlantedErrors, AreFound)
{
    const ToyError& error = GetParam();
    PlantedShaders shaders(std::string("toy_") + error.name);
    for (const char* contract : {"integrand.glsl", "candidates.glsl", "toy.glsl", "toy.h"})
        std::filesystem::copy(std::filesystem::path(TRICHROME_SOURCE_DIR "/tests/shaders/toy") / contract,
                              shaders.folder() / "path" / contract, std::filesystem::copy_options::overwrite_existing);
    ASSERT_NO_FATAL_FAILURE(shaders.plant(error.file, error.right, error.wrong));

    gpu::Device planted = openDevice({.shaderDirectory = shaders.folder().string()});
    const passes::Estimator& estimator = passes::estimatorOf(error.method);
    // No margin: what is not known well must not count as found.
    const TileVerdict verdict =
        ToyRenderer(planted, "", estimator, error.shift, error.runs, error.color).verdict(error.test, 1e-5, 1.0);
    EXPECT_FALSE(verdict.passes) << verdict.summary;
    std::printf("%s: %s\n", error.name, verdict.summary.c_str());
}

INSTANTIATE_TEST_SUITE_P(Of, ToyPlantedErrors, testing::ValuesIn(ERRORS), [](const auto& i) { return i.param.name; });

} // namespace
} // namespace support
