// Would the toy notice? Each of these errors, planted in the real stages' text and compiled at run time, must be found.

#include <cstdlib>
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
    const char* name; // of plantedErrors()
    Shift shift;
    ToyCase test;
    uint32_t runs = 256;
    passes::Method method = passes::Method::RgbRestir;
    passes::Color color = passes::Color::Chosen;
    passes::Mutate mutate = passes::Mutate::Off;
};
void PrintTo(const ToyError& error, std::ostream* os)
{
    *os << error.name;
}

constexpr passes::Method RGB = passes::Method::RgbRestir, LUMINANCE = passes::Method::RestirPt;
constexpr passes::Color CHOSEN = passes::Color::Chosen;
constexpr passes::Mutate FREE = passes::Mutate::Free;

const ToyError ERRORS[] = {
    {"WeightTimes1_02", Shift::Replay, {Temporal, true, 8}},
    {"MissingJacobian", Shift::Hybrid, {Temporal, true, 1}, 2040},
    {"SwappedTemporalMis", Shift::Replay, {Temporal, true, 8}},
    {"SwappedSpatialMis", Shift::Replay, {Spatial, false, 8}},
    {"TemporalConfidenceOffByOne", Shift::Hybrid, {Temporal, true, 8}},
    {"SpatialConfidenceOffByOne", Shift::Hybrid, {Spatial, true, 8}},
    {"StaleTarget", Shift::Replay, {Temporal, true, 64}},
    {"EmptyHistoryForgotten", Shift::Replay, {Temporal, true, 64}},
    {"FailedShiftForgotten", Shift::Hybrid, {Temporal, true, 8}},
    {"LuminanceWeights", Shift::Replay, {Temporal, true, 8}},
    {"NeighborsByContent", Shift::Replay, {Spatial, false, 8}},
    {"PathOfAnother", Shift::Hybrid, {Both, true, 64}},
    // What weighted color alone shows: reservoirs stay right.
    {"ColorOfOwnWeightTimes1_02",
     Shift::Replay,
     {Temporal, true, 1},
     1024,
     passes::Method::RestirPt,
     passes::Color::Weighted},
    {"ColorBySwappedTemporalWeights",
     Shift::Replay,
     {Temporal, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Weighted},
    {"ColorFromTheHistorysDomain",
     Shift::Replay,
     {Temporal, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Weighted},
    {"ColorFromTheNeighborsDomain",
     Shift::Hybrid,
     {Spatial, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Weighted},
    {"ColorByTheOwnMisWeight",
     Shift::Hybrid,
     {Spatial, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Weighted},
    {"ColorOfTheOwnSampleWhole",
     Shift::Hybrid,
     {Spatial, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Weighted},
    {"ColorOfAKeptShare2PercentTooLarge",
     Shift::Hybrid,
     {Spatial, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Weighted},
    {"ColorOfTheFirstPathTwice",
     Shift::Hybrid,
     {Temporal, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Weighted},
    // What mutations of history's samples alone show.
    {"MutationTooOften", Shift::Replay, {Temporal, false, 64, 12}, 1024, LUMINANCE, CHOSEN, FREE},
    {"MutationKeepsAnotherMeasure", Shift::Hybrid, {Temporal, true, 64, 12}, 1024, RGB, CHOSEN, FREE},
    {"MutationToAnotherKind", Shift::Replay, {Temporal, false, 64, 12}, 1024, LUMINANCE, CHOSEN, FREE},
    {"MutationByChosenPathsAlone", Shift::Replay, {Temporal, false, 64, 12}, 1024, LUMINANCE, CHOSEN, FREE},
    {"MutationForgetsTheOdds", Shift::Replay, {Temporal, false, 64, 12}, 1024, LUMINANCE, CHOSEN, FREE},
    {"MutationInAnotherDomain", Shift::Replay, {Temporal, true, 64, 12}, 1024, RGB, CHOSEN, FREE},
    // What the color estimate beside reservoirs alone shows.
    {"EstimateClamped", Shift::Hybrid, {Temporal, true, 8}, 1024, passes::Method::RestirPt, passes::Color::Variate},
    {"EstimateRatioFromTheSample",
     Shift::Hybrid,
     {Temporal, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Variate},
    {"EstimateShareKnowsTheSamples",
     Shift::Hybrid,
     {Temporal, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Variate},
    {"EstimateRatioForgottenOnce",
     Shift::Hybrid,
     {Temporal, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Variate},
    {"EstimateFromTheHistorysDomain",
     Shift::Hybrid,
     {Temporal, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Variate},
    {"EstimateBySwappedMis",
     Shift::Hybrid,
     {Temporal, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Variate},
    {"EstimateOfNeighborsTimes1_02",
     Shift::Hybrid,
     {Spatial, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Variate},
    {"EstimateOfTenthsOfTheDifference",
     Shift::Hybrid,
     {Spatial, true, 8},
     1024,
     passes::Method::RestirPt,
     passes::Color::Variate},
};

class ToyPlantedErrors : public GpuTest, public testing::WithParamInterface<ToyError>
{
};

TEST_P(ToyPlantedErrors, AreFound)
{
    const ToyError& error = GetParam();
    if (isSlow(device()) && error.name != std::string("MissingJacobian") && !std::getenv("TRICHROME_TEST_DRIVERS"))
        GTEST_SKIP() << "SKIPPED ON SwiftShader: takes minutes; TRICHROME_TEST_DRIVERS=1 asks for it";
    PlantedShaders shaders(std::string("toy_") + error.name);
    for (const char* contract : {"domain.glsl", "shift.glsl", "candidates.glsl", "toy.glsl", "toy.h"})
        std::filesystem::copy(std::filesystem::path(TRICHROME_SOURCE_DIR "/tests/shaders/toy") / contract,
                              shaders.folder() / "path" / contract, std::filesystem::copy_options::overwrite_existing);
    shaders.plant(plantedError(error.name));

    gpu::Device planted = openDevice({.shaderDirectory = shaders.folder().string()});
    const passes::Estimator& estimator = passes::estimatorOf(error.method);
    // No margin: what is not known well must not count as found.
    const TileVerdict verdict = ToyRenderer(planted, "", estimator, error.shift, error.runs, error.color, error.mutate)
                                    .verdict(error.test, 1e-5, 1.0);
    EXPECT_FALSE(verdict.passes) << verdict.summary;
    std::printf("%s: %s\n", error.name, verdict.summary.c_str());
}

INSTANTIATE_TEST_SUITE_P(Of, ToyPlantedErrors, testing::ValuesIn(ERRORS), [](const auto& i) { return i.param.name; });

} // namespace
} // namespace support
