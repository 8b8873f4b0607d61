// The real stages canonical, temporal, spatial_trace and spatial_gather, on integrals known in closed form: the means
// are the integrals, whatever the estimator, the shift, the reuse, the motion and M_c.

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "tests/shaders/toy/toy.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/toy_world.h"

namespace support
{
namespace
{

using passes::Color;
using passes::Mutate;
using passes::Shift;

constexpr Shift SHIFTS[] = {Shift::Replay, Shift::Reconnection, Shift::Hybrid};

// Those that ship, and one with as many reservoirs as fit: every channel is estimated twice.
std::vector<passes::Estimator> allEstimators()
{
    std::vector<passes::Estimator> list = passes::estimators();
    const glm::vec3 red(1, 0, 0), green(0, 1, 0), blue(0, 0, 1), all(1, 1, 1);
    list.push_back({.name = "four",
                    .target = {red, green, blue, all},
                    .resolve = {0.5f * red, 0.5f * green, 0.5f * blue, 0.5f * all}});
    return list;
}

struct Row {
    passes::Estimator estimator;
    Shift shift;
    Color color;
    Mutate mutate;

    std::string name() const
    {
        constexpr const char *NAMES[] = {"Replay", "Reconnection", "Hybrid"}, *COLORS[] = {"", "Weighted", "Variate"};
        std::string name =
            estimator.name + NAMES[size_t(shift)] + COLORS[size_t(color)] + (mutate == Mutate::Off ? "" : "Mutated");
        std::erase(name, '-');
        return name;
    }
};
void PrintTo(const Row& row, std::ostream* os)
{
    *os << row.name();
}

bool asksAll()
{
    return std::getenv("TRICHROME_TEST_MATRIX") != nullptr;
}

// Without the matrix: every estimator with hybrid shifts, which replay and reconnect, and every shift with one of them;
// and every way of reading color that shows another picture.
std::vector<Row> rows()
{
    std::vector<Row> list;
    for (const passes::Estimator& estimator : allEstimators())
        for (const Shift shift : SHIFTS)
            for (const Color color : {Color::Chosen, Color::Weighted, Color::Variate})
                for (const Mutate mutate : {Mutate::Off, Mutate::Free}) {
                    if (color != Color::Chosen && oneHot(estimator)) continue;
                    if (asksAll() || shift == Shift::Hybrid || estimator.name == "rgb-restir")
                        list.push_back({estimator, shift, color, mutate});
                }
    return list;
}

class ToyIntegrals : public GpuTest, public testing::WithParamInterface<Row>
{
};

// Some of everything; with TRICHROME_TEST_MATRIX set everything with everything, known to a fraction of a percent.
struct Plan {
    std::vector<ToyCase> cases;
    uint32_t runs = 64;
    double margin = 0.1;
};

Plan plan(const passes::Estimator& estimator, Mutate mutate)
{
    using enum Reuse;
    if (!asksAll())
        return {.cases = {{Temporal, true, 8},
                          {Spatial, true, 1},
                          {Both, false, 4096},
                          {Both, true, 8},
                          {.reuse = Both, .moves = true, .maxConfidence = 8, .colorConfidence = 2}}};
    // Few reservoirs leave channels to chance, which takes more runs: these fill lavapipe's largest binding. Without
    // reuse in space a quarter of them tells as much.
    const auto multiple = [](size_t runs) { return uint32_t(runs / shared::TOY_GROUP * shared::TOY_GROUP); };
    const uint32_t runs = multiple(8192 / estimator.target.size()), few = multiple(runs / 4);
    Plan all{.cases = {}, .runs = runs, .margin = 0.01};
    for (const bool moves : {false, true}) {
        if (mutate == Mutate::Off) all.cases.push_back({Spatial, moves, 1, 2, few}); // M_c limits history alone
        // So many frames that M_c limits the last ones' history. (4096 frames in time alone are not reached: no limit.)
        for (const auto& [limit, frames] : {std::pair(1u, 6u), {8u, 12u}, {64u, 72u}, {4096u, 12u}})
            all.cases.push_back({Temporal, moves, limit, frames, few});
        for (const auto& [limit, frames] : {std::pair(1u, 6u), {8u, 6u}, {64u, 6u}, {4096u, 9u}})
            all.cases.push_back({Both, moves, limit, frames});
    }
    return all;
}

TEST_P(ToyIntegrals, AreTheMeans)
{
    const Plan asked = plan(GetParam().estimator, GetParam().mutate);
    const double level = 1e-3 / double(2 * rows().size() * asked.cases.size()); // two tests each, 1e-3 for all of them
    ToyRenderer renderer(device(), TEST_SPIRV_DIR "/", GetParam().estimator, GetParam().shift, asked.runs,
                         GetParam().color, GetParam().mutate);
    for (const ToyCase& c : asked.cases) {
        const TileVerdict verdict = renderer.verdict(c, level, asked.margin);
        EXPECT_TRUE(verdict.passes) << c.name();
        std::printf("%s:\n%s\n", c.name().c_str(), verdict.summary.c_str());
    }
}

INSTANTIATE_TEST_SUITE_P(Of, ToyIntegrals, testing::ValuesIn(rows()), [](const auto& i) { return i.param.name(); });

using ToyWorld = GpuTest;

// What leaving out the shifts of a resting camera changes: nothing.
TEST_F(ToyWorld, NeedsNoShiftsAtRest)
{
    for (const Shift shift : {Shift::Replay, Shift::Hybrid}) { // reconnection moves not every path, not even home
        ToyRenderer renderer(device(), TEST_SPIRV_DIR "/", allEstimators().back(), shift, 8);
        const ToyCase resting = {.reuse = Reuse::Both, .maxConfidence = 64};
        const std::vector<image::Image> without = renderer.render(resting, true),
                                        with = renderer.render(resting, false);
        size_t different = 0, compared = 0;
        for (size_t run = 0; run < with.size(); ++run)
            for (size_t i = 0; i < with[run].pixels.size(); ++i, ++compared)
                for (int c = 0; c < 3; ++c)
                    different += !(std::abs(with[run].pixels[i][c] - without[run].pixels[i][c]) <= 2e-6f);
        EXPECT_LE(different, compared / 1000);
    }
}

// With targets of one channel each, all samples of a reservoir have one color: chosen and weighted color are
// one picture, for which the product compiles the cheaper one. With luminance they do not.
TEST_F(ToyWorld, OneHotTargetsShowOnePicture)
{
    for (const passes::Method method : {passes::Method::RestirPt, passes::Method::RgbRestir}) {
        const passes::Estimator& estimator = passes::estimatorOf(method);
        ToyRenderer chosen(device(), TEST_SPIRV_DIR "/", estimator, Shift::Hybrid, 8);
        ToyRenderer weighted(device(), TEST_SPIRV_DIR "/", estimator, Shift::Hybrid, 8, Color::Weighted);
        for (const Reuse reuse : {Reuse::Temporal, Reuse::Spatial, Reuse::Both}) {
            const ToyCase c = {.reuse = reuse, .moves = true, .maxConfidence = 8};
            const std::vector<image::Image> a = chosen.render(c), b = weighted.render(c);
            size_t different = 0;
            for (size_t i = 0; i < a[0].pixels.size(); ++i)
                for (int channel = 0; channel < 3; ++channel)
                    different += !(std::abs(a[0].pixels[i][channel] - b[0].pixels[i][channel]) <= 4e-6f);
            EXPECT_EQ(different == 0, oneHot(estimator)) << estimator.name << ", " << c.name() << ": " << different;
        }
    }
}

} // namespace
} // namespace support
