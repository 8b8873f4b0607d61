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
    const passes::Estimator& rgb = passes::estimatorOf(passes::Method::RgbRestir);
    // No margin: what is not known well must not count as found.
    const TileVerdict verdict = ToyRenderer(planted, "", rgb, error.shift, error.runs).verdict(error.test, 1e-5, 1.0);
    EXPECT_FALSE(verdict.passes) << verdict.summary;
    std::printf("%s: %s\n", error.name, verdict.summary.c_str());
}

INSTANTIATE_TEST_SUITE_P(Of, ToyPlantedErrors, testing::ValuesIn(ERRORS), [](const auto& i) { return i.param.name; });

} // namespace
} // namespace support
