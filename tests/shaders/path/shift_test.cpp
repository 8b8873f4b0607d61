// The shift maps on a real scene: identities at home, T after its inverse, J times its inverse, J against the random
// numbers themselves, and the errors that must be found.

#include <cstdio>
#include <filesystem>

#include "tests/support/gpu_fixture.h"
#include "tests/support/planted_shaders.h"
#include "tests/support/shift_findings.h"

namespace support
{
namespace
{

using passes::Shift;

void print(const ShiftFindings& found)
{
    for (const auto& [name, tally] : found.tallies())
        std::printf("%-20s %6zu paths, %3zu beyond %g; median %.1e, 99%% %.1e, 99.9%% %.1e, largest %.1e\n", name,
                    tally->errors.size(), tally->wrong(), Tally::TOLERANCE, tally->quantile(0.5), tally->quantile(0.99),
                    tally->quantile(0.999), tally->quantile(1));
    for (const auto& [kind, count] : found.kinds) std::printf("%6zu %s\n", count, kind.c_str());
    for (const auto& [outcome, count] : found.outcomes) std::printf("%6zu outcome %d\n", count, outcome);
}

class Shifts : public GpuTest, public testing::WithParamInterface<Shift>
{
};

// Where x_r is met at a grazing angle, rounding of the random numbers (24 bits) moves it about: hence quantiles.
TEST_P(Shifts, AreInvertibleWithTheirJacobian)
{
    if (isSlow(device()) && GetParam() != Shift::Replay)
        GTEST_SKIP() << "SKIPPED ON SwiftShader: takes five minutes to compile there";
    ShiftLab lab(device(), TEST_SPIRV_DIR "/", GetParam());
    const ShiftFindings found = findingsOf(lab, GetParam(), 8);
    print(found);
    for (const auto& [name, tally] : found.tallies()) {
        EXPECT_GT(tally->errors.size(), 1000u) << name;
        EXPECT_LE(tally->quantile(0.5), 1e-6) << name;
        EXPECT_LE(tally->quantile(0.99), 1e-3) << name;
    }
    EXPECT_LE(found.undefined.wrong(), found.undefined.errors.size() / 1000); // rounding turns single decisions
    for (const auto& [outcome, count] : found.outcomes)
        EXPECT_TRUE(outcome >= 0 && outcome < int(shared::SHIFT_OUTCOMES)) << count << " times " << outcome;

    // Every way to light, and every pair of surfaces that can be joined.
    std::vector<std::string> kinds = {"dirac sampled", "lamp sampled", "sky sampled",
                                      "lamp met",      "sky met",      "replayed"};
    for (const char* from : {"diffuse", "glossy", "through"})
        for (const char* to : {"diffuse", "glossy", "through", "light"})
            if (GetParam() != Shift::Replay && std::string(from) + to != "throughlight")
                kinds.push_back(std::string(from) + " to " + to);
    for (const std::string& kind : kinds)
        EXPECT_GE(found.kinds.count(kind) != 0 ? found.kinds.at(kind) : 0, 50u) << kind;
}

std::string nameOf(const testing::TestParamInfo<Shift>& info)
{
    constexpr const char* NAMES[] = {"Replay", "Reconnection", "Hybrid"};
    return NAMES[size_t(info.param)];
}
INSTANTIATE_TEST_SUITE_P(Of, Shifts, testing::Values(Shift::Replay, Shift::Reconnection, Shift::Hybrid), nameOf);

// An error planted in one place, or the same in two that must agree, and what has to find it.
struct ShiftError {
    struct Plant {
        const char* file; // below shaders/
        const char* right;
        const char* wrong;
    };
    const char* name;
    std::vector<Plant> plants;
    Tally ShiftFindings::*finder;
};
void PrintTo(const ShiftError& error, std::ostream* os)
{
    *os << error.name;
}

const ShiftError ERRORS[] = {
    {"MissingCosine",
     {{"path/walk.glsl", "abs(dot(next.geometricNormal, wo)) / dot(d, d)", "1.0 / dot(d, d)"},
      {"path/shift.glsl", "abs(dot(at.geometricNormal, direction)) / squared", "1.0 / squared"}},
     &ShiftFindings::jacobian},
    {"MissingDensity",
     {{"path/reconnection.glsl", "arrival : arrival * departure;", "arrival : arrival;"}},
     &ShiftFindings::jacobian},
    {"JacobianTimes1_02",
     {{"path/shift.glsl", "x.throughput * f * measure", "1.02 * x.throughput * f * measure"}},
     &ShiftFindings::home},
    {"DensityOfWhereItCameFrom",
     {{"path/shift.glsl", "pdf * measure, departure);\n            settle", "pdf, departure);\n            settle"}},
     &ShiftFindings::density},
};

class ShiftErrors : public GpuTest, public testing::WithParamInterface<ShiftError>
{
};

TEST_P(ShiftErrors, AreFound)
{
    if (isSlow(device())) GTEST_SKIP() << "SKIPPED ON SwiftShader: takes minutes to compile there";
    const ShiftError& error = GetParam();
    PlantedShaders shaders(std::string("shift_") + error.name);
    for (const char* file : {"shifts.h", "candidates_test.comp", "shift_test.comp"})
        std::filesystem::copy(std::filesystem::path(TRICHROME_SOURCE_DIR "/tests/shaders/path") / file,
                              shaders.folder() / file);
    for (const ShiftError::Plant& plant : error.plants)
        shaders.plant({error.name, plant.file, plant.right, plant.wrong});
    gpu::Device planted = openDevice({.shaderDirectory = shaders.folder().string()});
    ShiftLab lab(planted, "", Shift::Hybrid);
    const ShiftFindings found = findingsOf(lab, Shift::Hybrid, 1);
    print(found);
    const Tally& finder = found.*error.finder;
    EXPECT_GT(finder.wrong(), finder.errors.size() / 10); // 1 in 100 would fail the test above
}

INSTANTIATE_TEST_SUITE_P(Of, ShiftErrors, testing::ValuesIn(ERRORS), [](const auto& i) { return i.param.name; });

} // namespace
} // namespace support
