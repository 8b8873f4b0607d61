// Checkpoints: a render that goes on from one ends with the same bits, and no damaged or foreign file is believed.

#include "passes/checkpoint.h"

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "passes/camera_path.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/program.h"
#include "tests/support/test_scenes.h"

#include <random>
#include <stdexcept>

namespace
{

using passes::Checkpoint;
using passes::Method;
using passes::Renderer;
using passes::Settings;

Checkpoint small()
{
    return {.identity = {{"version", "1"}, {"scene", "h\xffll"}},
            .seconds = 0.1,
            .state = {.frames = (uint64_t{1} << 60) + 1,
                      .historyFrames = 2,
                      .camera = {.position = {0.1f, 1e-30f, -3, 0}},
                      .buffers = {{"Film", {std::byte{1}, std::byte{2}, std::byte{3}}}, {"Color", {}}}}};
}

std::string refusalOf(std::span<const std::byte> bytes)
{
    try {
        passes::parseCheckpoint(bytes, "x.ckpt");
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

std::string differenceOf(const passes::Identity& now)
{
    try {
        passes::requireSame(small(), now, "x.ckpt");
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

TEST(Checkpoint, ReadsBackWhatWasWritten)
{
    const TemporaryDirectory directory;
    passes::write(directory / "x.ckpt", small());
    const Checkpoint read = passes::readCheckpoint(directory / "x.ckpt"), expected = small();
    EXPECT_EQ(read.seconds, expected.seconds);
    EXPECT_EQ(read.state.frames, expected.state.frames);
    EXPECT_EQ(read.state.historyFrames, expected.state.historyFrames);
    EXPECT_EQ(read.state.camera.position, expected.state.camera.position);
    EXPECT_EQ(read.state.buffers, expected.state.buffers);
    EXPECT_NO_THROW(passes::requireSame(read, expected.identity, ""));
    EXPECT_EQ(directory.entries(), std::vector<std::string>{"x.ckpt"});
}

TEST(Checkpoint, RefusesEveryCutAndEveryDamagedByteInOneSentence)
{
    const TemporaryDirectory directory;
    passes::write(directory / "x.ckpt", small());
    std::vector<std::byte> bytes = files::read(directory / "x.ckpt");
    ASSERT_EQ(refusalOf(bytes), "");
    for (size_t size = 0; size < bytes.size(); ++size)
        EXPECT_NE(refusalOf(std::span(bytes).first(size)).find("\"x.ckpt\""), std::string::npos) << size;
    for (std::byte& byte : bytes)
        for (const std::byte flip : {std::byte{1}, std::byte{0x80}}) {
            byte ^= flip;
            EXPECT_NE(refusalOf(bytes), "") << &byte - bytes.data();
            byte ^= flip;
        }
    bytes.push_back(std::byte{0});
    EXPECT_NE(refusalOf(bytes), "");
}

TEST(Checkpoint, NamesWhatIsDifferent)
{
    EXPECT_EQ(differenceOf({{"version", "1"}, {"scene", "h\xffll"}}), "");
    EXPECT_EQ(differenceOf({{"version", "2"}, {"scene", "h\xffll"}}),
              R"(Cannot resume from "x.ckpt": its version is "1", not "2".)");
    EXPECT_EQ(differenceOf({{"version", "1"}}),
              "Cannot resume from \"x.ckpt\": it was rendered with scene \"h\uFFFDll\".");
    EXPECT_EQ(differenceOf({{"version", "1"}, {"scene", "h\xffll"}, {"orbit", "3"}}),
              R"(Cannot resume from "x.ckpt": it was rendered without orbit "3".)");
}

// ------------------------------------------------------------------------------------------------------ of a renderer

class CheckpointOfRenderer : public RendererFixture
{
  protected:
    static Settings settings(Method method, passes::Color color = passes::Color::Weighted,
                             passes::Mutate mutate = passes::Mutate::Off)
    {
        Settings s;
        s.method = method;
        s.color = color;
        s.mutate = mutate;
        s.width = 24;
        s.height = 20;
        s.maxBounces = 3;
        s.spatial = 2;
        s.spatialRadius = 4;
        return s;
    }

    static void render(Renderer& renderer, const passes::CameraAt& cameraAt, uint64_t until)
    {
        while (renderer.frameCount() < until) {
            if (cameraAt) renderer.setCamera(cameraAt(renderer.frameCount()));
            renderer.renderFrame();
        }
    }

    static scene::Scene glossy()
    {
        for (const support::TestScene& test : support::testScenes())
            if (std::string(test.name) == "Glossy") return test.make();
        throw std::invalid_argument("Glossy");
    }
};

TEST_F(CheckpointOfRenderer, GoesOnToTheSameBitsWhetherTheCameraRestsOrMoves)
{
    const scene::Scene scene = glossy();
    const TemporaryDirectory directory;
    using Case = std::pair<Settings, double>;
    for (const auto& [asked, orbit] :
         {Case{settings(Method::Pt), 2.0}, Case{settings(Method::RestirPt), 0.0},
          Case{settings(Method::RestirPt, passes::Color::Variate), 2.0}, Case{settings(Method::RgbRestir), 2.0},
          Case{settings(Method::RestirPt, passes::Color::Chosen, passes::Mutate::Free), 0.0},
          Case{settings(Method::RgbRestir, passes::Color::Weighted, passes::Mutate::Free), 2.0}}) {
        SCOPED_TRACE(fmt::format("method {}, color {}, {} degrees", int(asked.method), int(asked.color), orbit));
        const passes::CameraAt cameraAt = orbit > 0 ? passes::cameraOrbit(scene.cameras.at(0), orbit) : nullptr;
        Renderer whole(device(), scene, asked);
        render(whole, cameraAt, 3);
        passes::write(directory / "x.ckpt", {.state = whole.save()}); // saving disturbs nothing
        render(whole, cameraAt, 5);

        Renderer second(device(), scene, asked);
        EXPECT_EQ(second.scene().fingerprint(), whole.scene().fingerprint());
        render(second, cameraAt, 2); // what was there before is forgotten
        second.restore(passes::readCheckpoint(directory / "x.ckpt").state);
        EXPECT_EQ(second.frameCount(), 3u);
        render(second, cameraAt, 5);
        EXPECT_EQ(second.read(passes::MEAN).pixels, whole.read(passes::MEAN).pixels);
        EXPECT_EQ(second.read(passes::LAST_FRAME).pixels, whole.read(passes::LAST_FRAME).pixels);
        EXPECT_EQ(second.stats().rays, whole.stats().rays);
    }
}

// Whoever writes a checkpoint can also write its fingerprints: whatever it holds, frames end, on a device that is
// robust.
TEST_F(CheckpointOfRenderer, ForgedContentsDoNoHarm)
{
    const scene::Scene scene = glossy();
    for (const Method method : {Method::RestirPt, Method::RgbRestir}) {
        Renderer renderer(device(), scene, settings(method, passes::Color::Variate));
        render(renderer, nullptr, 1);
        passes::RendererState state = renderer.save();
        std::mt19937 random(7);
        for (auto& [name, bytes] : state.buffers)
            for (std::byte& byte : bytes) byte = std::byte(random());
        for (const double degrees : {0.0, 3.0}) { // shifts are left out while the camera rests
            renderer.restore(state);
            render(renderer, passes::cameraOrbit(scene.cameras.at(0), degrees), 3);
            EXPECT_EQ(renderer.read(passes::LAST_FRAME).pixels.size(), 24u * 20u);
        }
    }
}

TEST_F(CheckpointOfRenderer, FitsNoOtherMethodOrSizeAndNoOtherSceneHasItsFingerprint)
{
    scene::Scene scene = glossy();
    Renderer renderer(device(), scene, settings(Method::Pt));
    const passes::RendererState state = renderer.save();
    Settings larger = settings(Method::Pt);
    larger.width += 8;
    EXPECT_THROW(Renderer(device(), scene, larger).restore(state), Error);
    EXPECT_THROW(Renderer(device(), scene, settings(Method::RestirPt)).restore(state), Error);

    scene.materials.at(0).baseColor.x *= 0.999f;
    const Renderer painted(device(), scene, settings(Method::Pt));
    scene.cameras.at(0).position.x += 1e-3;
    const Renderer moved(device(), scene, settings(Method::Pt));
    EXPECT_NE(painted.scene().fingerprint(), renderer.scene().fingerprint());
    EXPECT_NE(moved.scene().fingerprint(), painted.scene().fingerprint());
}

} // namespace
