// ReSTIR stays unbiased where the scene itself moves: the mean of single frames is the path tracer's picture of the
// scene as that frame has it, whatever the history.

#include <cmath>
#include <cstdlib>
#include <memory>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/scene/motion.h"
#include "engine/scene/shapes.h"
#include "passes/estimator.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/gpu_pictures.h"
#include "tests/support/moving_worlds.h"
#include "tests/support/planted_shaders.h"
#include "tests/support/restir_cases.h"
#include "tests/support/test_scenes.h"

namespace support
{
namespace
{

using enum passes::Method;
using enum passes::Shift;
using enum passes::Color;
using enum Reuse;

// With TRICHROME_TEST_MATRIX set: everything with everything, in the room in which all light has passed what moves.
std::vector<RestirCase> movingCases()
{
    std::vector<RestirCase> cases;
    if (std::getenv("TRICHROME_TEST_MATRIX") == nullptr) {
        cases = {
            {"BallRolls", RgbRestir, Hybrid, Both, false, 8},
            {"BallRolls", RestirPt, Hybrid, Both, true, 8},
            {"BallJumps", RgbRestir, Reconnection, Temporal, false, 64, 300},
            {"BallParks", RgbRestir, Hybrid, Temporal, false, 64, 200, 5},
            {"BallVanishes", RgbRestir, Hybrid, Both, false, 8},
            {"BallGrows", RgbRestir, Reconnection, Both, false, 8},
            {"WallStretches", RgbRestir, Hybrid, Both, false, 64, 300},
            {"WallStretches", RestirPt, Reconnection, Temporal, false, 8, 300, 6},
            {"BallMirrored", RgbRestir, Hybrid, Both, false, 8},
            {"BallWobbles", GroupedRestir, Hybrid, Both, true, 8},
            {"CopiesTurn", RgbRestir, Hybrid, Both, false, 8},
            {"CopiesTurn", RestirPt, Reconnection, Temporal, true, 64, 300, 6},
            {"LampMoves", RgbRestir, Hybrid, Both, false, 8},
            {"LampChanges", RgbRestir, Hybrid, Both, false, 8, 600, 5},
            {"LampChanges", RestirPt, Replay, Temporal, false, 64, 300, 6},
            {"LightsWander", RgbRestir, Hybrid, Both, false, 8, 900},
            {"PaintDries", RgbRestir, Hybrid, Both, false, 8, 300},
            {"MirrorMoves", RgbRestir, Hybrid, Both, false, 8},
            {"GlassMoves", RgbRestir, Hybrid, Both, false, 8, 800},
            {"PanesSlide", RgbRestir, Hybrid, Both, false, 8, 300},
            {"BumpsMove", RestirPt, Hybrid, Both, false, 8},
            {"OrthographicBall", RgbRestir, Hybrid, Both, true, 8},
            {"RoomRebuilds", RgbRestir, Hybrid, Both, false, 8, 1500},
            {"RoomRebuilds", RestirPt, Reconnection, Temporal, true, 8, 600},
            {"RoomRebuilds", GroupedRestir, Replay, Both, false, 8, 450},
            {"RoomRebuilds", RestirPt, Hybrid, Both, false, 8, 600, 4, Variate},
            {"LampChanges", RestirPt, Hybrid, Temporal, false, 8, 1500, 5, Variate},
            {"PaintDries", RestirPt, Hybrid, Both, true, 8, 300, 4, Variate},
            {"PanesSlide", RestirPt, Replay, Temporal, false, 8, 300, 5, Variate},
        };
        return cases;
    }
    cases = {{"CeilingLit", RgbRestir, Hybrid, Both, false, 64, 12000, 5},         // what StaleSuffix is planted in
             {"LampChanges", RestirPt, Hybrid, Both, false, 8, 4000, 5, Variate}}; // too long for the choice above
    for (const passes::Method method : {RestirPt, RgbRestir, GroupedRestir})
        for (const passes::Shift shift : {Replay, Reconnection, Hybrid})
            for (const Reuse reuse : {Temporal, Both})
                for (const bool moves : {false, true})
                    for (const auto& [maxConfidence, frames] : {std::pair(1u, 3u), {8u, 6u}, {64u, 5u}})
                        for (const char* scene : {"RoomRebuilds", "WallStretches"})
                            for (const passes::Color color : {Chosen, Weighted, Variate}) {
                                if (color != Chosen && oneHot(passes::estimatorOf(method))) continue;
                                cases.push_back(
                                    {scene, method, shift, reuse, moves, maxConfidence, 8000, frames, color});
                            }
    return asFamily(std::move(cases));
}

class MovingAgreement : public GpuTest, public testing::WithParamInterface<RestirCase>
{
};

TEST_P(MovingAgreement, WithThePathTracer)
{
    const TileVerdict verdict = GetParam().verdict(device());
    RecordProperty("verdict", verdict.summary);
    EXPECT_TRUE(verdict.passes) << verdict.summary;
}

INSTANTIATE_TEST_SUITE_P(Of, MovingAgreement, testing::ValuesIn(movingCases()),
                         [](const auto& i) { return i.param.name(); });

class MovingWorlds : public GpuTest
{
  protected:
    // A floor under a light of strength r from frame 20 on, 1 before.
    static double lightStepBias(gpu::Device& device, float r)
    {
        const auto sceneAt = [r](uint32_t frame) {
            scene::Scene scene;
            scene::addQuad(scene, scene::addMaterial(scene, scene::diffuse("floor", {0.6f, 0.5f, 0.4f})), {-2, 0, 2},
                           {4, 0, 0}, {0, 0, -4});
            scene.cameras.push_back(scene::lookAt("camera", {0, 2, 3}, {0, 0, 0}, 30));
            scene.lights.push_back({.intensity = glm::vec3(frame < 20 ? 1 : r), .position = {0.5f, 2, 0}});
            scene.motion = std::make_shared<scene::Motion>();
            return scene;
        };
        passes::Settings settings;
        settings.width = settings.height = 16;
        settings.maxBounces = 1;
        settings.method = RgbRestir;
        settings.shift = Replay;
        settings.spatial = 0;
        settings.maxConfidence = 20;
        settings.frames = 21;
        settings.average = false;
        const PictureEstimates got = renderRuns(device, sceneAt(0), settings, 2, {}, sceneAt);
        settings.method = Pt;
        settings.frames = 1;
        const PictureEstimates truth = renderRuns(device, sceneAt(20), settings, 2);
        return got.whole.tiles[0][0].mean / truth.whole.tiles[0][0].mean - 1;
    }
};

// A light of which one point is all: nothing is left to chance. Who reads the current lights for the previous target
// has the bias B(r) = 1 / (1 + c) - r / (r + c); who reads the previous ones has none.
TEST_F(MovingWorlds, ALightThatChangesHasItsOldStrengthInThePreviousFrame)
{
    for (const float r : {2.0f, 0.5f, 10.0f}) EXPECT_NEAR(lightStepBias(device(), r), 0, 1e-5) << r;
    PlantedShaders shaders("PreviousWorldForgotten");
    shaders.plant(plantedError("PreviousWorldForgotten"));
    gpu::Device planted = openDevice({.shaderDirectory = shaders.folder().string()});
    for (const double r : {2.0, 0.5, 10.0}) {
        const double c = 20;
        EXPECT_NEAR(lightStepBias(planted, float(r)), 1 / (1 + c) - r / (r + c), 1e-4) << r;
    }
}

// Camera and everything else under one rigid motion: the picture is that of the world at rest, to rounding.
TEST_F(MovingWorlds, AWorldThatMovesWithItsCameraRests)
{
    const auto sceneAt = [](uint32_t frame) {
        scene::Scene scene = cabinet();
        scene.environment = {}; // which light is picked how often depends on where the sky's sphere is
        const glm::vec3 way = 0.25f * float(frame) * glm::vec3(1, 0.5f, -1);
        transform(scene, 0, scene.triangles.size(), glm::translate(glm::mat4(1), way));
        for (scene::PunctualLight& light : scene.lights) light.position += way;
        scene.cameras[0].position += glm::dvec3(way);
        scene.motion = std::make_shared<scene::Motion>();
        return scene;
    };
    for (const passes::Shift shift : {Replay, Reconnection, Hybrid}) {
        passes::Settings settings;
        settings.width = settings.height = 48;
        settings.method = RgbRestir;
        settings.shift = shift;
        settings.maxConfidence = 1000;
        settings.average = false;
        const auto render = [&](bool moves) {
            passes::Renderer renderer(device(), sceneAt(0), settings, {.moves = moves});
            for (uint32_t frame = 0; frame < 6; ++frame) {
                if (moves) renderer.setScene(sceneAt(frame), frame);
                if (moves) renderer.setCamera(sceneAt(frame).cameras[0]);
                renderer.renderFrame();
            }
            return renderer.read(passes::LAST_FRAME).pixels;
        };
        const std::vector<glm::vec3> rests = render(false), moves = render(true);
        size_t same = 0;
        for (size_t i = 0; i < rests.size(); ++i) {
            const float size = std::max({rests[i].r, rests[i].g, rests[i].b, 1e-3f});
            same += glm::length(rests[i] - moves[i]) < 0.01f * size;
        }
        EXPECT_GT(double(same) / double(rests.size()), 0.95) << int(shift);
    }
}

} // namespace
} // namespace support
