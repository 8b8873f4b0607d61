#include "tests/support/restir_cases.h"

#include "engine/base/check.h"
#include "passes/estimator.h"
#include "tests/support/gpu_pictures.h"
#include "tests/support/moving_worlds.h"
#include "tests/support/test_scenes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <map>
#include <tuple>
#include <utility>

namespace support
{

namespace
{

constexpr uint32_t PT_FRAMES = 1500;

// Everything with everything, in one scene. Luminance leaves red to chance, so it takes many runs to know 1% of it.
std::vector<RestirCase> restirMatrix()
{
    using enum passes::Method;
    using enum passes::Shift;
    using enum passes::Color;
    using enum Reuse;
    std::vector<RestirCase> cases;
    for (const passes::Method method : {RestirPt, RgbRestir, GroupedRestir})
        for (const passes::Shift shift : {Replay, Reconnection, Hybrid})
            for (const Reuse reuse : {Temporal, Spatial, Both})
                for (const bool moves : {false, true})
                    for (const auto& [maxConfidence, frames] : {std::pair(1u, 4u), {8u, 10u}, {64u, 6u}, {4096u, 9u}})
                        for (const passes::Color color : {Chosen, Weighted, Variate})
                            for (const passes::Mutate mutate : {passes::Mutate::Off, passes::Mutate::Free}) {
                                if (color != Chosen && oneHot(passes::estimatorOf(method))) continue;
                                if (mutate != passes::Mutate::Off && reuse == Spatial) continue; // no history
                                cases.push_back({"Glossy", method, shift, reuse, moves, maxConfidence, 4800, frames,
                                                 color, mutate});
                            }
    // Other scenes, which take too long to be among the choice below.
    cases.push_back({"AlphaBlend", RgbRestir, Hybrid, Both, true, 8});
    cases.push_back({"FrostedGlass", RgbRestir, Hybrid, Both, true, 8, 800});
    cases.push_back({"SunnySky", RestirPt, Replay, Both, true, 8});
    cases.push_back({"Room", RestirPt, Reconnection, Both, true, 64, 450, 5, Variate});
    return asFamily(std::move(cases));
}

} // namespace

std::string RestirCase::name() const
{
    constexpr const char* METHODS[] = {"Pt", "Luminance", "Rgb", "Grouped"};
    constexpr const char* SHIFTS[] = {"Replay", "Reconnection", "Hybrid"};
    constexpr const char* REUSES[] = {"Temporal", "Spatial", "Both"};
    return std::string(scene) + METHODS[size_t(method)] + SHIFTS[size_t(shift)] + REUSES[size_t(reuse)] +
           (moves ? "Moving" : "Resting") + std::to_string(maxConfidence) +
           std::array{"Chosen", "", "Variate"}[size_t(color)] + std::array{"", "Mutated"}[size_t(mutate)];
}

void PrintTo(const RestirCase& c, std::ostream* os)
{
    *os << c.name();
}

TileVerdict RestirCase::verdict(gpu::Device& device) const
{
    passes::Settings settings;
    scene::Scene world;
    SceneAt sceneAt;
    for (const TestScene& test : testScenes()) {
        if (test.name != std::string(scene)) continue;
        world = test.make();
        settings = test.settings();
    }
    for (const MovingWorld& test : movingWorlds()) {
        if (test.name != std::string(scene)) continue;
        sceneAt = test.at;
        world = test.at(0);
        settings.maxBounces = test.maxBounces;
    }
    CHECK(!world.triangles.empty() && "there is such a scene");
    settings.width = settings.height = 24;
    const passes::CameraAt cameraAt = passes::cameraOrbit(world.cameras.at(0), moves ? 3 : 0);

    const uint32_t lastFrame = frames - 1;
    const uint32_t traceFrames = sceneAt ? std::clamp(8 * runs, PT_FRAMES, 12000u) : PT_FRAMES;
    using View = std::tuple<std::string, bool, uint32_t, uint32_t>; // scene, moves, frame, traced
    static std::map<View, PictureEstimates> traced;                 // the matrix asks again and again
    PictureEstimates& expected = traced[{scene, moves, moves || sceneAt ? lastFrame : 0, traceFrames}];
    if (expected.tiles.tiles.empty()) {
        scene::Scene last = sceneAt ? sceneAt(lastFrame) : world; // as the last frame sees it
        last.cameras[0] = cameraAt(lastFrame);
        expected = renderFrames(device, last, settings, traceFrames);
    }

    settings.seed = seed;
    settings.method = method;
    settings.shift = shift;
    settings.temporal = reuse != Reuse::Spatial;
    settings.spatial = reuse == Reuse::Temporal ? 0 : 3;
    settings.spatialRadius = 5;
    settings.maxConfidence = maxConfidence;
    settings.color = color;
    settings.mutate = mutate;
    settings.frames = frames;
    settings.average = false;

    // Looked at after 1, 2, 4 ... batches of runs, each look with its share of the levels. What differs will not agree
    // later; what agrees is rendered on until each tile is known within 2%, since opposite errors in two tiles cancel
    // in the whole.
    const uint32_t batches = batchesOf(runs);
    const double share = 1.0 / (std::bit_width(batches - 1) + 1);
    const Levels levels{level * share, 0.05 * share};
    TileVerdict verdict;
    uint32_t batch = 0;
    renderRuns(device, world, settings, runs, cameraAt, sceneAt, [&](const PictureEstimates& got) {
        if (!std::has_single_bit(++batch) && batch != batches) return false;
        verdict = picturesAgree(got, expected, 0.01, DEVICE_ROUNDING, levels);
        return !tilesAgree(got.tiles, expected.tiles, levels.differ, DEVICE_ROUNDING).passes ||
               (verdict.passes && tilesAreEquivalent(got.tiles, expected.tiles, 0.02, levels.equivalent).passes);
    });
    return verdict;
}

std::vector<RestirCase> asFamily(std::vector<RestirCase> cases, double level)
{
    const double each = statistics::sidakLevel(level, cases.size());
    for (size_t i = 0; i < cases.size(); ++i) {
        cases[i].level = each;
        cases[i].seed = 1000 * (i + 1);
    }
    return cases;
}

std::vector<RestirCase> restirCases()
{
    if (std::getenv("TRICHROME_TEST_MATRIX") != nullptr) return restirMatrix();
    using enum passes::Method;
    using enum passes::Shift;
    using enum passes::Color;
    using enum Reuse;
    constexpr passes::Mutate FREE = passes::Mutate::Free;
    return {
        {"Lambert", RgbRestir, Replay, Temporal, true, 8},
        {"Lambert", RgbRestir, Hybrid, Both, true, 64},
        {"Lambert", RestirPt, Reconnection, Spatial, false, 8, 200, 5, Chosen},
        {"RoughMetal", RgbRestir, Reconnection, Both, true, 8},
        {"SmoothMetal", RgbRestir, Hybrid, Both, true, 64, 700},
        {"Mirror", RgbRestir, Hybrid, Both, true, 8},
        {"Glossy", GroupedRestir, Hybrid, Both, true, 8, 200, 5, Chosen},
        {"ClearGlassBall", RgbRestir, Hybrid, Both, true, 8},
        {"FrostedPane", RgbRestir, Reconnection, Both, true, 8},
        {"Panes", RgbRestir, Hybrid, Temporal, false, 8},
        {"Panes", RestirPt, Replay, Both, false, 8, 800},
        {"FarTriangle", RgbRestir, Reconnection, Both, false, 8},
        {"Dome", RgbRestir, Hybrid, Both, true, 8, 600},
        {"NormalMap", RestirPt, Hybrid, Both, true, 8},
        {"Glossy", RestirPt, Hybrid, Both, true, 8, 200, 5, Variate},
        {"AlphaBlend", RestirPt, Replay, Both, true, 8, 400, 5, Variate},
        {"FrostedGlass", RestirPt, Hybrid, Both, true, 8, 800, 5, Variate},
        {"ManyLamps", GroupedRestir, Hybrid, Temporal, true, 4096, 200, 5, Variate},
        {"Glossy", RestirPt, Hybrid, Both, false, 64, 400, 12, Weighted, FREE},
        {"Glossy", RgbRestir, Hybrid, Both, true, 8, 400, 8, Weighted, FREE},
        {"AlphaBlend", RgbRestir, Hybrid, Both, true, 8, 400, 5, Weighted, FREE},
        {"FrostedGlass", RestirPt, Replay, Both, true, 8, 800, 5, Chosen, FREE},
        {"Panes", RestirPt, Hybrid, Temporal, false, 8, 400, 5, Weighted, FREE},
        {"Room", RestirPt, Reconnection, Both, true, 64, 450, 5, Variate, FREE},
        {"ManyLamps", GroupedRestir, Hybrid, Temporal, false, 4096, 200, 12, Chosen, FREE},
        {"Copies", RgbRestir, Hybrid, Both, true, 8},
        {"MaskedCopies", RestirPt, Reconnection, Both, true, 8},
        {"GlassCopies", RgbRestir, Hybrid, Both, false, 8},
        {"PointLight", RgbRestir, Hybrid, Both, true, 1},
        {"SunnySky", RgbRestir, Hybrid, Both, true, 8},
        {"TwoSidedLamp", RgbRestir, Hybrid, Both, true, 8},
        {"ManyLamps", RgbRestir, Hybrid, Both, true, 4096},
        {"Room", RgbRestir, Hybrid, Both, true, 64, 450},
        {"Room", RestirPt, Replay, Both, true, 8, 450, 5, Chosen},
        {"Room", GroupedRestir, Reconnection, Temporal, false, 8},
        {"Orthographic", RgbRestir, Hybrid, Both, true, 8},
    };
}

} // namespace support
