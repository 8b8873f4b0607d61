// Camera paths made key by key are those that `render` reads.

#include "ui/window/camera_keys.h"

#include "engine/base/error.h"
#include "passes/camera_path.h"
#include "tests/support/program.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace
{

ui::Pose poseFrom(double x)
{
    return {.position = {x, 1, 5}, .target = {x, 0.5, 0}, .yfov = 40 + x};
}

} // namespace

TEST(CameraKeys, StandInTheOrderOfTheirFramesAndReplaceEachOther)
{
    EXPECT_TRUE(ui::framesOf(nullptr).empty());
    ui::CameraKeys keys = ui::withKey(nullptr, 30, poseFrom(3));
    keys = ui::withKey(keys, 60, poseFrom(6));
    keys = ui::withKey(keys, 0, poseFrom(0));
    keys = ui::withKey(keys, 45, poseFrom(1));
    const ui::CameraKeys before = keys;
    keys = ui::withKey(keys, 45, poseFrom(4));
    EXPECT_EQ(ui::framesOf(keys), (std::vector<int64_t>{0, 30, 45, 60}));
    EXPECT_EQ(ui::poseAt(keys, {}, 45).position.x, 4);
    EXPECT_EQ(ui::poseAt(before, {}, 45).position.x, 1);
    EXPECT_NEAR(ui::poseAt(keys, {}, 45).yfov, 44, 1e-9);
    keys = ui::withoutKey(keys, 45);
    EXPECT_EQ(ui::framesOf(keys), (std::vector<int64_t>{0, 30, 60}));
    EXPECT_EQ(ui::framesOf(ui::withoutKey(keys, 31)), ui::framesOf(keys));
    for (const int64_t frame : {0, 60}) keys = ui::withoutKey(keys, frame);
    EXPECT_EQ(ui::withoutKey(keys, 30), nullptr);
}

TEST(CameraKeys, TheRestOfAWayIsTheSameToTheBit)
{
    ui::CameraKeys keys = ui::withKey(nullptr, 2, poseFrom(0.1));
    keys = ui::withKey(keys, 9, poseFrom(0.7));
    keys = ui::withKey(keys, 12, poseFrom(0.3));
    const glm::dvec3 origin(0.3, 0.1, 0.7);
    const passes::CameraAt whole = passes::cameraPath(*keys, {}, origin);
    const passes::CameraAt rest = passes::cameraPath(ui::pathFrom(keys, 7), {}, origin);
    for (uint64_t frame = 0; frame < 9; ++frame) EXPECT_TRUE(rest(frame) == whole(frame + 7)) << frame;
    EXPECT_EQ(ui::pathFrom(keys, 0), *keys);
}

TEST(CameraKeys, APathOnWhichTheCameraLooksNowhereIsRefused)
{
    ui::CameraKeys keys = ui::withKey(nullptr, 0, {.position = {-1, 0, 0}});
    EXPECT_THROW(ui::withKey(keys, 2, {.position = {1, 0, 0}}), Error); // in the middle it is at its target
    keys = ui::withKey(keys, 1, {.position = {0, 0, 1}});
    keys = ui::withKey(keys, 2, {.position = {1, 0, 0}});
    EXPECT_THROW(ui::withoutKey(keys, 1), Error);
    EXPECT_THROW(ui::withKey(keys, passes::MAX_KEYFRAME + 1, poseFrom(0)), Error);
}

TEST(CameraKeys, AreLoadedAsTheyStandInTheFile)
{
    const TemporaryDirectory directory;
    const std::string file = directory / "path.json";
    // Without up and field of view, which are the scene's camera's.
    const std::string text = R"({"keyframes":[{"frame":-3,"position":[0,0,1],"target":[0,0,0]}]})";
    writeFile(file, text);
    const ui::CameraKeys keys = ui::loadKeys(file);
    EXPECT_EQ(keys->dump(), text);
    EXPECT_NEAR(ui::poseAt(keys, {.yfov = 1}, 0).yfov, glm::degrees(1.0), 1e-9);
    writeFile(file, "{}");
    EXPECT_THROW(ui::loadKeys(file), Error);
}
