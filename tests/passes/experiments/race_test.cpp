// Methods in turns, references and their cache: on a scene of a few pixels.
// Covers passes/experiments/reference.cpp.

#include "passes/experiments/race.h"

#include <cmath>
#include <fstream>

#include "engine/base/error.h"
#include "engine/scene/procedural.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/program.h"

namespace
{

using passes::Precision;
using passes::Race;
using passes::Reference;
using passes::References;
using passes::Settings;

class RaceTest : public RendererFixture
{
  protected:
    void SetUp() override
    {
        RendererFixture::SetUp();
        settings_.width = 16;
        settings_.height = 12;
        settings_.maxBounces = 2;
        restir_ = settings_;
        restir_.method = passes::Method::RestirPt;
        restir_.spatial = 0;
    }

    static scene::Scene cornell()
    {
        for (const scene::BuiltInScene& scene : scene::builtInScenes())
            if (std::string(scene.name) == "cornell") return scene.make();
        throw Error("There is no scene cornell.");
    }
    References references(const passes::Renderer& sharing, const Precision& precision, passes::CameraAt at = {}) const
    {
        return {sharing, settings_, std::move(at), {.precision = precision, .cache = directory_ / "cache"}};
    }
    std::vector<std::string> cached() const
    {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(directory_ / "cache"))
            names.push_back(entry.path().string());
        return names;
    }
    static passes::Repeat run(Race& race, References& references, uint64_t seed)
    {
        return race.run(
            seed, references, [](double) {}, [] { return false; });
    }

    const scene::Scene scene_ = cornell();
    Settings settings_, restir_;
    TemporaryDirectory directory_;
};

constexpr Precision QUICK = {.error = 1e-4, .maxFrames = 256};

} // namespace

TEST(Race, MeasuresAtHalfOctavesAndMovingCamerasAtOctaves)
{
    std::vector<uint64_t> resting, moving;
    for (uint64_t frames = 1; frames <= 100; ++frames) {
        if (passes::isCheckpoint(frames, false)) resting.push_back(frames);
        if (passes::isCheckpoint(frames, true)) moving.push_back(frames);
    }
    EXPECT_EQ(resting, (std::vector<uint64_t>{1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96}));
    EXPECT_EQ(moving, (std::vector<uint64_t>{1, 2, 4, 8, 16, 32, 64}));
}

TEST_F(RaceTest, MethodsInTurnsGiveThePicturesThatTheyGiveAlone)
{
    Race race(device(), scene_, {settings_, restir_}, {}, {.frames = 5});
    References against = references(race.renderer(), QUICK);
    const passes::Repeat repeat = run(race, against, 42);
    ASSERT_TRUE(repeat.complete);
    EXPECT_EQ(repeat.nonFinite, 0u);
    ASSERT_EQ(repeat.finals.size(), 2u);
    const Settings* const all[] = {&settings_, &restir_};
    for (size_t method = 0; method < 2; ++method) {
        Settings alone = *all[method];
        alone.seed = 42;
        passes::Renderer renderer(device(), scene_, alone);
        for (int frame = 0; frame < 5; ++frame) renderer.renderFrame();
        EXPECT_EQ(renderer.read(passes::MEAN).pixels, repeat.finals[method].pixels) << method;
    }
}

TEST_F(RaceTest, SamplesAreAtCheckpointsAndTheEndWithTimesThatGrow)
{
    Race race(device(), scene_, {settings_, restir_}, {}, {.frames = 5});
    References against = references(race.renderer(), QUICK);
    const passes::Repeat repeat = run(race, against, 1);
    for (uint32_t method = 0; method < 2; ++method)
        for (const bool average : {true, false}) {
            std::vector<uint64_t> frames;
            double seconds = 0;
            for (const passes::Sample& sample : repeat.samples) {
                if (sample.method != method || sample.average != average) continue;
                frames.push_back(sample.frames);
                EXPECT_GT(sample.deviceSeconds, seconds);
                EXPECT_GT(sample.wallSeconds, 0);
                seconds = sample.deviceSeconds;
            }
            EXPECT_EQ(frames, (std::vector<uint64_t>{1, 2, 3, 4, 5}));
        }
    // One frame is its own mean.
    EXPECT_EQ(repeat.samples[0].error.mse, repeat.samples[1].error.mse);
}

TEST_F(RaceTest, ByTimeEachMethodRunsUntilItsOwnTimeIsOver)
{
    Race race(device(), scene_, {settings_, restir_}, {}, {.seconds = 0.2, .sliceSeconds = 0.02});
    References against = references(race.renderer(), QUICK);
    const passes::Repeat repeat = run(race, against, 1);
    double last[2] = {};
    for (const passes::Sample& sample : repeat.samples) last[sample.method] = sample.wallSeconds;
    for (const double seconds : last) EXPECT_GE(seconds, 0.2);
}

// 1/n: what the path tracer's mean must do against a reference whose own error is subtracted.
TEST_F(RaceTest, ThePathTracersErrorFallsAsOneOverFrames)
{
    Race race(device(), scene_, {settings_}, {}, {.frames = 64});
    References against = references(race.renderer(), {.error = 1e-4, .maxFrames = 1024});
    double first = 0, last = 0;
    constexpr int REPEATS = 12;
    for (uint64_t seed = 0; seed < REPEATS; ++seed)
        for (const passes::Sample& sample : run(race, against, seed).samples) {
            if (!sample.average) continue;
            if (sample.frames == 4) first += sample.error.mse / REPEATS;
            if (sample.frames == 64) last += sample.error.mse / REPEATS;
        }
    EXPECT_NEAR(first / last, 16, 4);
}

TEST_F(RaceTest, AMovingCameraIsMeasuredAgainstEachFramesOwnView)
{
    const passes::CameraAt orbit = passes::cameraOrbit(scene_.cameras[0], 20);
    Race race(device(), scene_, {settings_}, orbit, {.frames = 4});
    constexpr Precision PRECISION = {.error = 1e-4, .maxFrames = 512};
    References against = references(race.renderer(), PRECISION, orbit);
    const passes::Repeat repeat = run(race, against, 1);
    ASSERT_EQ(repeat.samples.size(), 3u); // after 1, 2 and 4 frames
    EXPECT_EQ(against.made().size(), 3u);
    for (const passes::Sample& sample : repeat.samples) EXPECT_FALSE(sample.average);
    // To the bit what cameras see that never moved from there, and far from what the first frame saw.
    const image::Image& own = against.after(4)->picture;
    scene::Scene there = scene_;
    there.cameras[0] = orbit(3);
    passes::Renderer resting(device(), there, settings_);
    References ofResting(resting, settings_, {}, {.precision = PRECISION, .cache = directory_ / "other"});
    EXPECT_FALSE(ofResting.after(1)->fromCache);
    EXPECT_EQ(own.pixels, ofResting.after(1)->picture.pixels);
    Settings alone = settings_;
    alone.seed = 1;
    resting.apply(alone);
    for (int frame = 0; frame < 4; ++frame) resting.renderFrame();
    EXPECT_EQ(resting.read(passes::LAST_FRAME).pixels, repeat.finals[0].pixels);
    EXPECT_GT(image::measure(against.after(1)->picture, own).relmse, 0.05);
}

TEST_F(RaceTest, StopsWhenTold)
{
    Race race(device(), scene_, {settings_, restir_}, {}, {.frames = 1000000});
    References against = references(race.renderer(), QUICK);
    int calls = 0;
    const passes::Repeat repeat = race.run(
        1, against, [](double) {}, [&] { return ++calls > 6; });
    EXPECT_FALSE(repeat.complete);
    EXPECT_FALSE(repeat.samples.empty());
    References never(race.renderer(), settings_, {}, {.precision = QUICK, .stop = [] { return true; }});
    EXPECT_EQ(never.after(1), nullptr);
}

TEST_F(RaceTest, AReferenceIsAsPreciseAsAskedForOrSaysThatItIsNot)
{
    Race race(device(), scene_, {settings_}, {}, {.frames = 1});
    References good = references(race.renderer(), {.error = 0.1, .maxFrames = 1 << 14});
    const Reference& precise = *good.after(1);
    EXPECT_TRUE(precise.precise);
    EXPECT_LE(std::sqrt(precise.error.relmse), 0.1);
    EXPECT_LT(precise.pathTraced, 1u << 14);
    References poor = references(race.renderer(), QUICK);
    EXPECT_FALSE(poor.after(1)->precise);
    EXPECT_EQ(poor.after(1)->pathTraced, 256u);
    // It estimates its own error well: against another one, independent and better.
    References better = references(race.renderer(), {.error = 1e-4, .maxFrames = 4096});
    const double real = image::measure(better.after(1)->picture, poor.after(1)->picture).mse;
    const double estimated = poor.after(1)->error.mse;
    EXPECT_NEAR(estimated / real, 1, 0.3);
}

TEST_F(RaceTest, CachedReferencesAreFoundAndBadOnesMadeAgain)
{
    Race race(device(), scene_, {settings_}, {}, {.frames = 1});
    const auto make = [&](const Precision& precision) {
        References list = references(race.renderer(), precision);
        return *list.after(1);
    };
    const Reference first = make(QUICK);
    EXPECT_FALSE(first.fromCache);
    ASSERT_EQ(cached().size(), 1u);
    const std::string file = cached()[0], bytes = readFile(file);
    const Reference again = make(QUICK);
    EXPECT_TRUE(again.fromCache);
    EXPECT_EQ(again.picture.pixels, first.picture.pixels);
    EXPECT_EQ(again.error.relmse, first.error.relmse);
    EXPECT_EQ(again.error.chromaMse, first.error.chromaMse);
    EXPECT_EQ(again.pathTraced, first.pathTraced);
    EXPECT_EQ(again.precise, first.precise);

    EXPECT_FALSE(make({.error = 1e-4, .maxFrames = 128}).fromCache); // other precision, other name
    EXPECT_EQ(cached().size(), 2u);
    std::filesystem::copy_file(cached()[0] == file ? cached()[1] : cached()[0], file, // foreign
                               std::filesystem::copy_options::overwrite_existing);
    EXPECT_FALSE(make(QUICK).fromCache);
    EXPECT_EQ(readFile(file), bytes);
    for (const std::string& damaged : {std::string(), std::string("no picture"), bytes.substr(0, bytes.size() / 2)}) {
        writeFile(file, damaged);
        EXPECT_FALSE(make(QUICK).fromCache) << damaged.size();
        EXPECT_EQ(readFile(file), bytes);
    }
    EXPECT_TRUE(make(QUICK).fromCache);

    scene::Scene other = scene_; // another scene, same settings
    other.materials.front().baseColor *= 0.5f;
    passes::Renderer renderer(device(), other, settings_);
    References foreign = references(renderer, QUICK);
    EXPECT_FALSE(foreign.after(1)->fromCache);
}

TEST_F(RaceTest, AReferenceFromAFileMustFit)
{
    image::Image picture{.width = 16, .height = 12, .pixels = std::vector<glm::vec3>(size_t{16} * 12, glm::vec3(0.5f))};
    const std::string file = directory_ / "r.exr";
    image::write(file, picture, {});
    References list(file, settings_);
    EXPECT_EQ(list.after(3)->picture.pixels, picture.pixels);
    EXPECT_EQ(list.after(3)->error.mse, 0);
    picture.pixels[5].g = std::nanf("");
    image::write(file, picture, {});
    EXPECT_THROW(References(file, settings_), Error);
    settings_.width = 15;
    EXPECT_THROW(References(file, settings_), Error);
}
