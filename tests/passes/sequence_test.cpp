// Which time a frame of a sequence shows, and that renderers are brought there.

#include "passes/sequence.h"

#include <memory>

#include <gtest/gtest.h>

#include "engine/scene/motion.h"
#include "engine/scene/shapes.h"
#include "tests/support/gpu_fixture.h"

namespace passes
{
namespace
{

// A lamp that goes up by 1 m in 2 s, and a camera that goes with it.
scene::Scene risingLamp()
{
    scene::Scene scene;
    scene::addQuad(scene, scene::addMaterial(scene, scene::emitter("lamp", {1, 2, 3})), {-1, -1, 0}, {2, 0, 0},
                   {0, 2, 0});
    scene.cameras.push_back(scene::lookAt("camera", {0, 0, 3}, {0, 0, 0}, 30));
    const auto motion = std::make_shared<scene::Motion>();
    motion->nodes.resize(1);
    motion->lenses.push_back({.yfov = scene.cameras[0].yfov});
    motion->cameras.push_back({.camera = 0, .node = 0, .lens = 0, .rest = scene.cameras[0]});
    motion->numbers = {{0, 2}, {0, 0, 0, 0, 1, 0}};
    motion->animations.push_back(
        {.name = "rise",
         .channels = {{.property = scene::Property::Translation, .width = 3, .times = 0, .values = 1}},
         .seconds = 2});
    scene.motion = motion;
    return scene;
}

TEST(Playback, GoesOnByStepsAndBeginsAgain)
{
    const scene::Scene scene = risingLamp();
    Playback play{.animations = {0}, .start = 0.5, .step = 0.25};
    const auto at = [&](int64_t frame) { return play.secondsAt(frame, *scene.motion); };
    EXPECT_EQ(at(0), 0.5);
    EXPECT_EQ(at(4), 1.5);
    EXPECT_EQ(at(6), 0); // the last key is the first
    EXPECT_EQ(at(-2), 0);
    EXPECT_EQ(at(-3), 1.75); // what a warm-up sees
    EXPECT_EQ(at(6 + 8 * 1000), 0);
    play.loop = false;
    EXPECT_EQ(at(6), 2);
    EXPECT_EQ(at(100), 2);
    EXPECT_EQ(at(-3), 0);
    play.step = -0.25;
    EXPECT_EQ(at(1), 0.25);
    EXPECT_EQ(at(9), 0);
    play.animations.clear();
    EXPECT_EQ(at(9), 0);
}

class SequenceOfFrames : public GpuTest
{
};

TEST_F(SequenceOfFrames, BringsSceneAndCamera)
{
    scene::Scene scene = risingLamp();
    const Sequence sequence(scene, {.animations = {0}, .step = 0.5}, 0);
    EXPECT_TRUE(sequence.moves() && sequence.sceneMoves());
    Settings settings;
    settings.width = settings.height = 8;
    Renderer renderer(device(), scene, settings, {.moves = true});
    for (int64_t frame = 0; frame < 3; ++frame) {
        sequence.bring(renderer, frame);
        EXPECT_EQ(renderer.sceneSeconds(), 0.5 * double(frame));
        EXPECT_NEAR(scene.cameras[0].position.y, 0.25 * double(frame), 1e-6);
        renderer.renderFrame();
    }
    const RendererState state = renderer.save();
    EXPECT_NE(state.camera.position.y, 0);
}

TEST_F(SequenceOfFrames, OfACameraAloneLeavesTheSceneAlone)
{
    scene::Scene scene = risingLamp();
    const Sequence still, orbit = cameraOrbit(scene.cameras[0], 90);
    EXPECT_FALSE(still.moves());
    EXPECT_TRUE(orbit.moves());
    EXPECT_FALSE(orbit.sceneMoves());
    Settings settings;
    settings.width = settings.height = 8;
    Renderer renderer(device(), scene, settings);
    orbit.bring(renderer, 1);
    renderer.renderFrame();
    EXPECT_NE(renderer.save().camera.position.x, 0);
    orbit.bring(renderer, -5); // as frame 0
    EXPECT_EQ(renderer.save().camera.position.x, 0);
}

} // namespace
} // namespace passes
