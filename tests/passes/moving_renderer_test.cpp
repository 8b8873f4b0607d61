// Renderers of scenes that move: which world a frame shows, which one it remembers, and who has which.

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "engine/base/error.h"
#include "engine/scene/motion.h"
#include "engine/scene/shapes.h"
#include "passes/inspector.h"
#include "passes/renderer.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/moving_worlds.h"

namespace
{

using passes::Renderer;
using Pixels = std::vector<glm::vec3>;

class MovingRenderer : public RendererFixture
{
  protected:
    static scene::Scene worldAt(const std::string& name, uint32_t frame)
    {
        for (const support::MovingWorld& world : support::movingWorlds())
            if (world.name == name) return world.at(frame);
        throw std::invalid_argument(name);
    }
    static scene::Scene ball(uint32_t frame) { return worldAt("BallRolls", frame); }
    static passes::Settings settings(passes::Method method)
    {
        passes::Settings s;
        s.method = method;
        s.width = s.height = 32;
        s.maxBounces = 3;
        s.spatial = 2;
        s.spatialRadius = 4;
        s.shift = passes::Shift::Hybrid;
        return s;
    }
    Renderer renderer(const scene::Scene& scene, const passes::Settings& settings, bool moves)
    {
        if (!pipelines_) pipelines_ = std::make_shared<passes::PipelinePool>(device());
        return {device(), scene, settings, {.pipelines = pipelines_, .moves = moves}};
    }
    Renderer moving(const scene::Scene& scene, const passes::Settings& settings)
    {
        return renderer(scene, settings, true);
    }
    static Pixels lastFrame(Renderer& renderer) { return renderer.read(passes::LAST_FRAME).pixels; }
    static size_t different(const Pixels& a, const Pixels& b)
    {
        size_t count = 0;
        for (size_t p = 0; p < a.size(); ++p) count += !(glm::distance(a[p], b[p]) <= 1e-4f * glm::length(b[p]));
        return count;
    }
    static void expectFinite(Renderer& renderer)
    {
        for (const auto& [stage, count] : renderer.stats().nonFinite) EXPECT_EQ(count, 0u) << stage;
    }
    static uint64_t primaryRays(Renderer& renderer) { return renderer.stats().rays.at("primary"); }

    static constexpr uint64_t PIXELS = uint64_t{32} * 32;

  private:
    std::shared_ptr<passes::PipelinePool> pipelines_; // shaders are compiled once a test
};

// Never moved it is the still scene, on lavapipe the path tracer's to the bit: the tree is another one, shifts know of
// areas, and compilers reorder.
TEST_F(MovingRenderer, ThatNeverMovesGivesThePictureOfTheStillOne)
{
    for (const passes::Method method : {passes::Method::Pt, passes::Method::RgbRestir}) {
        Renderer still = renderer(ball(0), settings(method), false), moves = moving(ball(0), settings(method));
        for (int frame = 0; frame < 4; ++frame) {
            still.renderFrame();
            moves.renderFrame();
            const size_t pixels = different(lastFrame(moves), lastFrame(still));
            EXPECT_LE(pixels, 2u) << int(method) << ' ' << frame;
        }
        EXPECT_EQ(primaryRays(moves), primaryRays(still));
        expectFinite(moves);
    }
}

// In both worlds' places, pose after pose, the path tracer's frame is what a still renderer of that pose gives.
TEST_F(MovingRenderer, ShowsEachPoseAsAStillRendererDoes)
{
    for (const char* name : {"BallMirrored", "BallVanishes", "LampChanges", "LightsWander", "BumpsMove"}) {
        Renderer moves = moving(worldAt(name, 0), settings(passes::Method::Pt));
        // A lamp that is out is a light of power 0 there, and none in a still scene: other ones are picked
        // (LampChanges, 3).
        for (uint32_t frame = 0; frame < 3; ++frame) {
            moves.setScene(worldAt(name, frame), frame);
            moves.renderFrame();
            Renderer still(device(), worldAt(name, frame), settings(passes::Method::Pt),
                           {.pipelines = moves.pipelines()});
            for (uint32_t i = 0; i <= frame; ++i) still.renderFrame(); // of equal random numbers
            const size_t pixels = different(lastFrame(moves), lastFrame(still));
            EXPECT_LE(pixels, 4u) << name << ' ' << frame;
        }
        expectFinite(moves);
    }
}

TEST_F(MovingRenderer, ShowsTheLastPoseThatItWasGiven)
{
    const passes::Settings restir = settings(passes::Method::RgbRestir);
    Renderer direct = moving(ball(0), restir), detour = moving(ball(0), restir);
    for (uint32_t frame = 0; frame < 4; ++frame) {
        detour.setScene(ball(frame + 7), frame + 0.5);
        for (Renderer* renderer : {&detour, &direct}) {
            renderer->setScene(ball(frame), frame);
            EXPECT_EQ(renderer->sceneSeconds(), frame);
            renderer->renderFrame();
        }
        EXPECT_EQ(lastFrame(detour), lastFrame(direct)) << frame;
    }
    EXPECT_EQ(primaryRays(direct), 4 * PIXELS);
    expectFinite(direct);
}

// Boxes of the tree have grown on the way. From afar rays begin where the scene does, and that must not depend on them.
TEST_F(MovingRenderer, ShowsWhatItHasBeenThroughInNoPicture)
{
    const auto wallAt = [](double x) {
        scene::Scene scene;
        scene::addQuad(scene, scene::addMaterial(scene, scene::diffuse("wall", {0.5f, 0.5f, 0.5f})),
                       {float(x), -0.37f, 0.21f}, {1, 0.1f, 0}, {0, 1, 0.3f});
        scene.lights.push_back({.intensity = glm::vec3(100), .position = {0, 0, 30}});
        scene.cameras.push_back(scene::lookAt("camera", {3, 2, 30}, {0, 0, 0}, 12));
        scene.motion = std::make_shared<scene::Motion>();
        return scene;
    };
    const passes::Settings pt = settings(passes::Method::Pt);
    for (int i = 0; i < 8; ++i) {
        Renderer direct = moving(wallAt(0), pt), detour = moving(wallAt(0), pt);
        detour.setScene(wallAt(7 + 3 * i), 1);
        const double x = -0.9 + 0.11 * i;
        for (Renderer* renderer : {&direct, &detour}) {
            renderer->setScene(wallAt(x), 2);
            renderer->renderFrame();
        }
        EXPECT_EQ(lastFrame(detour), lastFrame(direct)) << x;
        EXPECT_NE(lastFrame(direct), Pixels(PIXELS, glm::vec3(0)));
    }
}

// While it stays where it is, frames are those of a scene that rests.
TEST_F(MovingRenderer, DoesNothingWhereItIsThereAlready)
{
    const passes::Settings restir = settings(passes::Method::RgbRestir);
    Renderer renderer = moving(ball(0), restir), once = moving(ball(0), restir);
    once.setScene(ball(2), 2);
    for (int frame = 0; frame < 4; ++frame) {
        renderer.setScene(frame == 0 ? ball(2) : ball(9), 2);
        renderer.renderFrame();
        once.renderFrame();
        EXPECT_EQ(lastFrame(renderer), lastFrame(once)) << frame;
    }
    EXPECT_EQ(primaryRays(renderer), PIXELS);
    renderer.setScene(ball(3), 3);
    renderer.renderFrame();
    renderer.renderFrame();
    EXPECT_EQ(primaryRays(renderer), 2 * PIXELS);
}

// Between reset() and the first frame there is no frame before: whatever was shown is forgotten.
TEST_F(MovingRenderer, StartsAgainAfterAReset)
{
    Renderer renderer = moving(ball(0), settings(passes::Method::RgbRestir));
    const auto play = [&] {
        Pixels last;
        for (uint32_t frame = 0; frame < 3; ++frame) {
            renderer.setScene(ball(frame), frame);
            renderer.renderFrame();
        }
        return lastFrame(renderer);
    };
    const Pixels first = play();
    renderer.reset();
    EXPECT_EQ(play(), first);
    renderer.setScene(ball(8), 8);
    renderer.reset(); // the pose that no frame has shown is the first one's now
    renderer.setScene(ball(9), 9);
    renderer.apply(renderer.settings());
    EXPECT_EQ(play(), first);
    expectFinite(renderer);
}

TEST_F(MovingRenderer, ASiblingHasItsOwnPoseAndSharesTextures)
{
    scene::Scene textured = ball(0);
    textured.uv0.resize(textured.positions.size());
    textured.images.push_back(
        {.width = 1024, .height = 1024, .rgba = std::vector<uint8_t>(size_t{4} * 1024 * 1024, 200)});
    textured.materials[1].baseColorTexture.image = uint32_t(textured.images.size() - 1);
    const auto sceneAt = [&](uint32_t frame) {
        scene::Scene scene = textured;
        scene.positions = ball(frame).positions;
        scene.normals = ball(frame).normals;
        return scene;
    };
    const passes::Settings restir = settings(passes::Method::RgbRestir);
    Renderer alone = moving(textured, restir), first = moving(textured, restir);
    const uint64_t before = device().allocatedBytes();
    Renderer sibling(first, restir);
    EXPECT_LT(device().allocatedBytes() - before, uint64_t{1024} * 1024 * 4);
    EXPECT_EQ(sibling.scene().fingerprint(), first.scene().fingerprint());
    for (uint32_t frame = 0; frame < 3; ++frame) {
        first.setScene(sceneAt(9 - frame), 9 - frame);
        sibling.setScene(sceneAt(frame), frame);
        alone.setScene(sceneAt(frame), frame);
        for (Renderer* renderer : {&first, &sibling, &alone}) renderer->renderFrame();
        EXPECT_EQ(lastFrame(sibling), lastFrame(alone)) << frame;
        EXPECT_NE(lastFrame(first), lastFrame(sibling)) << frame;
    }
    expectFinite(sibling);
}

TEST_F(MovingRenderer, GoesOnInTheMiddleOfMotionToTheSameBits)
{
    // Rests in frames 3 and 4: what the last one hit is known, also to whoever goes on from it.
    const auto seconds = [](uint32_t frame) { return frame < 3 ? frame : frame < 5 ? 2u : frame - 2; };
    const auto render = [&](Renderer& renderer, uint32_t until) {
        while (renderer.frameCount() < until) {
            const uint32_t at = seconds(uint32_t(renderer.frameCount()));
            renderer.setScene(ball(at), at);
            renderer.renderFrame();
        }
    };
    for (const passes::Method method : {passes::Method::Pt, passes::Method::RgbRestir})
        for (const uint32_t frames : {2u, 4u, 5u}) {
            Renderer whole = moving(ball(0), settings(method));
            render(whole, frames);
            const passes::RendererState state = whole.save();
            render(whole, 7);
            Renderer second = moving(ball(0), settings(method));
            EXPECT_EQ(second.scene().fingerprint(), whole.scene().fingerprint());
            render(second, 3); // forgotten
            second.restore(state);
            EXPECT_FALSE(second.sceneSeconds());
            const uint32_t last = seconds(frames - 1);
            second.setScene(ball(last), last);
            render(second, 7);
            EXPECT_EQ(lastFrame(second), lastFrame(whole)) << int(method) << ' ' << frames;
            EXPECT_EQ(second.read(passes::MEAN).pixels, whole.read(passes::MEAN).pixels);
            std::map<std::string, uint64_t> rays = second.stats().rays;
            // What pixels see is kept for reuse alone: the path tracer looks again.
            if (method == passes::Method::Pt && frames == 4) rays["primary"] -= PIXELS;
            EXPECT_EQ(rays, whole.stats().rays);
        }
}

// A pose that is refused is none: the next frame shows the one before. Pairs of triangles torn apart, in a chain of
// smaller and smaller ones whose tree is too deep.
TEST_F(MovingRenderer, ThatIsRefusedAPoseStaysInTheOneBefore)
{
    const auto quads = [](auto&& place) {
        scene::Scene scene;
        scene::addMaterial(scene, scene::diffuse("gray", {0.5f, 0.5f, 0.5f}));
        for (uint32_t i = 0; i < 400; ++i) {
            const auto [corner, size] = place(i);
            scene::addQuad(scene, 0, corner, {size, 0, 0}, {0, size, 0});
        }
        scene.lights.push_back({.intensity = glm::vec3(100), .position = {10, 10, 20}});
        scene.cameras.push_back(scene::lookAt("camera", {10, 10, 25}, {10, 10, 0}, 50));
        scene.motion = std::make_shared<scene::Motion>();
        return scene;
    };
    using Place = std::pair<glm::vec3, float>;
    const auto grid = [&](float z) {
        return quads([z](uint32_t i) {
            const uint32_t row = i / 20;
            return Place{{float(i % 20), float(row), z}, 0.5f};
        });
    };
    scene::Scene chain = quads([](uint32_t i) {
        const float s = std::pow(0.93f, float(i));
        return Place{{s, 0, s}, s};
    });
    for (size_t t = 1; t < chain.triangles.size(); t += 2)
        std::swap(chain.triangles[t].vertices[1], chain.triangles[t].vertices[2]);
    const passes::Settings restir = settings(passes::Method::RestirPt);
    Renderer renderer = moving(grid(0), restir), calm = moving(grid(0), restir);
    for (uint32_t frame = 0; frame < 3; ++frame) {
        for (Renderer* each : {&renderer, &calm}) each->setScene(grid(0.1f * float(frame)), frame);
        EXPECT_THROW(renderer.setScene(chain, 100 + frame), Error);
        EXPECT_EQ(renderer.sceneSeconds(), frame);
        for (int i = 0; i < 2; ++i) {
            for (Renderer* each : {&renderer, &calm}) each->renderFrame();
            EXPECT_EQ(lastFrame(renderer), lastFrame(calm)) << frame;
            EXPECT_THROW(renderer.setScene(chain, 200 + frame), Error);
        }
    }
    EXPECT_EQ(primaryRays(renderer), primaryRays(calm));
}

// A wall that slides to the right by three pixels was three pixels further left, and one that went to the left, right.
TEST_F(MovingRenderer, KnowsWherePointsOfWhatMovesWereSeenBefore)
{
    const passes::Settings restir = settings(passes::Method::RestirPt);
    const double pixel = 2 * std::tan(0.5 * 40 * 3.14159265358979 / 180) * 3 / restir.height; // at the wall
    const auto wallAt = [&](double pixels) {
        scene::Scene scene;
        scene::addQuad(scene, scene::addMaterial(scene, scene::diffuse("wall", {0.5f, 0.5f, 0.5f})),
                       {-4 + float(pixels * pixel), -4, 0}, {8, 0, 0}, {0, 8, 0});
        scene.lights.push_back({.intensity = glm::vec3(1), .position = {0, 0, 3}});
        scene.cameras.push_back(scene::lookAt("camera", {0, 0, 3}, {0, 0, 0}, 40));
        scene.motion = std::make_shared<scene::Motion>();
        return scene;
    };
    Renderer renderer = moving(wallAt(0), restir);
    const auto expectMoved = [&](int by) {
        size_t found = 0, wrong = 0;
        const std::vector<uint32_t> list = renderer.readPreviousPixels();
        for (uint32_t p = 0; p < list.size(); ++p) {
            if (list[p] == shared::NO_NEIGHBOR) continue;
            ++found;
            wrong +=
                list[p] % restir.width + uint32_t(by) != p % restir.width || list[p] / restir.width != p / restir.width;
        }
        EXPECT_EQ(wrong, 0u) << by;
        EXPECT_EQ(found, size_t(int(restir.width) - std::abs(by)) * restir.height) << by;
    };
    double place = 0;
    const auto move = [&](int by) {
        place += by;
        renderer.setScene(wallAt(place), place);
        renderer.renderFrame();
    };
    renderer.renderFrame();
    move(3);
    expectMoved(3);
    move(-5);
    expectMoved(-5);
    renderer.renderFrame();
    expectMoved(0);
    move(2);
    expectMoved(2);
}

// What it shows is the last frame, also where the next pose is there already.
TEST_F(MovingRenderer, IsInspectedAsTheLastFrameShowedIt)
{
    Renderer renderer = moving(ball(0), settings(passes::Method::RgbRestir));
    passes::Inspector inspector(renderer);
    for (uint32_t frame = 0; frame < 4; ++frame) {
        renderer.setScene(ball(frame), frame);
        renderer.renderFrame();
    }
    const auto seen = [&] {
        std::vector<float> numbers;
        for (uint32_t pixel = 0; pixel < PIXELS; pixel += 5)
            for (const auto& path : inspector.paths(pixel))
                for (size_t i = 0; i < path.size(); ++i) {
                    const shared::PathPoint& point = path[i];
                    if (i == 0) {
                        EXPECT_NEAR((0.5 + 0.5 * point.x / point.depth) * 32, pixel % 32 + 0.5, 0.01);
                        EXPECT_NEAR((0.5 - 0.5 * point.y / point.depth) * 32, uint32_t(pixel / 32) + 0.5, 0.01);
                    }
                    numbers.insert(numbers.end(), {point.x, point.y, point.depth, float(point.kind)});
                }
        return numbers;
    };
    const std::vector<float> before = seen();
    const std::vector<passes::ShiftCounts> shifts = inspector.shifts();
    EXPECT_GT(before.size(), 1000u);
    renderer.setScene(ball(9), 9);
    EXPECT_EQ(seen(), before);
    EXPECT_EQ(inspector.shifts(), shifts);
}

// Two files of one picture that move in different ways are not one scene.
TEST_F(MovingRenderer, IsOfAnotherSceneWhereItMovesOtherwise)
{
    const auto fingerprint = [](auto&& change) {
        scene::Scene scene = ball(0);
        scene::Motion motion;
        motion.numbers = {{0, 1}, {0, 0, 0, 1, 2, 3}};
        motion.nodes.emplace_back();
        motion.animations.push_back({.channels = {{.width = 3, .times = 0, .values = 1}}});
        change(motion);
        scene.motion = std::make_shared<scene::Motion>(motion);
        return passes::SceneOnDevice(device(), scene, scene.cameras[0], {.moves = true}).fingerprint();
    };
    const std::vector<uint64_t> all = {
        fingerprint([](scene::Motion&) {}),
        fingerprint([](scene::Motion& m) { m.numbers[1][5] = 4; }),
        fingerprint([](scene::Motion& m) { m.numbers[0][1] = 2; }),
        fingerprint([](scene::Motion& m) { m.animations[0].channels[0].property = scene::Property::Scale; }),
        fingerprint([](scene::Motion& m) { m.nodes[0].rest.translation.x = 1; }),
        fingerprint([](scene::Motion& m) { m.skins.push_back({.joints = {0}, .inverseBindings = {glm::dmat4(2)}}); }),
        fingerprint([](scene::Motion& m) { m.paints.push_back({.material = 1, .roughness = 0.5}); })};
    EXPECT_EQ(std::set(all.begin(), all.end()).size(), all.size());
    EXPECT_EQ(all[0], fingerprint([](scene::Motion&) {}));
}

} // namespace
