// Camera motion: what the keyframes say holds at the keyframes, between them nothing jerks, and a wrong file gets a
// sentence.

#include "passes/camera_path.h"

#include "engine/base/error.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <numbers>

using passes::CameraAt;
using Json = nlohmann::ordered_json;

namespace
{

scene::Scene threeCameras()
{
    scene::Scene scene;
    scene.name = "room";
    for (const char* name : {"door", "2", "door"}) scene.cameras.push_back({.name = name});
    return scene;
}

scene::Camera baseCamera()
{
    scene::Camera camera;
    camera.yfov = 1;
    camera.position = {1, 2, 6};
    camera.target = {1, 1, 1};
    camera.forward = glm::normalize(camera.target - camera.position);
    camera.right = {1, 0, 0};
    camera.up = glm::cross(camera.right, camera.forward);
    return camera;
}

Json threeKeys()
{
    return Json::parse(R"({"keyframes": [
        {"frame": 0,  "position": [0, 1, 5], "target": [0, 0, 0]},
        {"frame": 10, "position": [3, 1, 4], "target": [1, 0, 0], "up": [0, 1, 1], "yfov": 90},
        {"frame": 30, "position": [5, 2, 0], "target": [1, 1, 0], "yfov": 30}]})");
}

std::string messageOf(const std::string& json)
{
    try {
        passes::cameraPath(Json::parse(json), baseCamera(), {0, 0, 0});
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

void expectFrame(const scene::Camera& camera)
{
    EXPECT_NEAR(glm::length(camera.forward), 1, 1e-12);
    EXPECT_NEAR(glm::length(camera.right), 1, 1e-12);
    EXPECT_NEAR(glm::dot(camera.right, camera.forward), 0, 1e-12);
    EXPECT_NEAR(glm::distance(glm::cross(camera.right, camera.forward), camera.up), 0, 1e-12);
    EXPECT_NEAR(glm::distance(glm::normalize(camera.target - camera.position), camera.forward), 0, 1e-12);
}

} // namespace

TEST(ChooseCamera, TakesNamesBeforeIndicesAndTheFirstByDefault)
{
    EXPECT_EQ(passes::chooseCamera(threeCameras(), ""), 0u);
    EXPECT_EQ(passes::chooseCamera(threeCameras(), "door"), 0u);
    EXPECT_EQ(passes::chooseCamera(threeCameras(), "1"), 1u);
    EXPECT_EQ(passes::chooseCamera(threeCameras(), "2"), 1u); // a name
}

TEST(ChooseCamera, ListsTheCamerasWhenThereIsNoSuch)
{
    for (const char* wrong : {"3", "window", "-1", "1.0", "0x1", " 1", "4294967296"}) {
        try {
            passes::chooseCamera(threeCameras(), wrong);
            FAIL() << wrong;
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()), "The scene has no camera \"" + std::string(wrong) +
                                                     "\": it has 0 \"door\", 1 \"2\", 2 \"door\".");
        }
    }
}

TEST(CameraPath, PassesThroughItsKeyframesInWorldCoordinates)
{
    const glm::dvec3 origin(100, 0, -7);
    const CameraAt at = passes::cameraPath(threeKeys(), baseCamera(), origin);
    EXPECT_EQ(at(0).position, glm::dvec3(0, 1, 5) - origin);
    EXPECT_NEAR(at(0).yfov, 1, 1e-12); // of the base
    EXPECT_NEAR(glm::distance(at(10).position, glm::dvec3(3, 1, 4) - origin), 0, 1e-12);
    EXPECT_NEAR(glm::distance(at(10).target, glm::dvec3(1, 0, 0) - origin), 0, 1e-12);
    EXPECT_NEAR(at(10).yfov, std::numbers::pi / 2, 1e-12);
    EXPECT_EQ(at(30).position, glm::dvec3(5, 2, 0) - origin);
    EXPECT_EQ(at(31).position, at(30).position);
    EXPECT_EQ(at(1u << 30).target, at(30).target);
    for (uint64_t frame = 0; frame <= 31; ++frame) expectFrame(at(frame));
}

TEST(CameraPath, MayHaveBegunBeforeFrame0AndIsTheSameToTheBit)
{
    const glm::dvec3 origin(0.1, 0.2, 0.3);
    const CameraAt whole = passes::cameraPath(threeKeys(), baseCamera(), origin);
    Json later = threeKeys();
    for (Json& key : later["keyframes"]) key["frame"] = key["frame"].get<int64_t>() - 13;
    const CameraAt rest = passes::cameraPath(later, baseCamera(), origin);
    for (uint64_t frame = 0; frame <= 20; ++frame) EXPECT_TRUE(rest(frame) == whole(frame + 13)) << frame;
    for (Json& key : later["keyframes"]) key["frame"] = key["frame"].get<int64_t>() - 50;
    EXPECT_TRUE(passes::cameraPath(later, baseCamera(), origin)(0) == whole(30));
}

TEST(CameraPath, HoldsUntilItsFirstKeyframe)
{
    const CameraAt at = passes::cameraPath(
        Json::parse(R"({"keyframes": [{"frame": 5, "position": [0, 0, 1], "target": [0, 0, 0]}]})"), baseCamera(), {});
    EXPECT_EQ(at(0).position, glm::dvec3(0, 0, 1));
    EXPECT_EQ(at(9).position, glm::dvec3(0, 0, 1));
}

TEST(CameraPath, IsStraightAndEvenThroughEvenKeyframesOnALine)
{
    const CameraAt at = passes::cameraPath(Json::parse(R"({"keyframes": [
        {"frame": 0, "position": [0, 0, 5], "target": [0, 0, 0]},
        {"frame": 4, "position": [4, 0, 5], "target": [4, 0, 0]},
        {"frame": 6, "position": [6, 0, 5], "target": [6, 0, 0]}]})"),
                                           baseCamera(), {});
    for (uint64_t frame = 0; frame <= 6; ++frame) EXPECT_NEAR(at(frame).position.x, double(frame), 1e-12);
}

TEST(CameraPath, KeepsItsVelocityAcrossAKeyframe)
{
    // Keyframes ten thousand times further apart stand in for a derivative.
    Json path = threeKeys();
    for (Json& key : path["keyframes"]) key["frame"] = key["frame"].get<uint64_t>() * 10000;
    const CameraAt at = passes::cameraPath(path, baseCamera(), {});
    const glm::dvec3 before = at(100000).position - at(99999).position;
    const glm::dvec3 after = at(100001).position - at(100000).position;
    EXPECT_LT(glm::distance(before, after), 1e-3 * glm::length(before));
}

TEST(CameraPath, RefusesWithASentenceThatNamesTheKeyframe)
{
    const auto keys = [](const std::string& inside) { return R"({"keyframes": [)" + inside + "]}"; };
    const std::string good = R"({"frame": 3, "position": [0, 0, 1], "target": [0, 0, 0]})";
    const auto expect = [](const std::string& json, const std::string& part) {
        EXPECT_NE(messageOf(json).find(part), std::string::npos) << json << "\ngave: " << messageOf(json);
    };
    expect("[]", "at least one keyframe");
    expect(keys(""), "at least one keyframe");
    expect(R"({"keyframes": 1})", "at least one keyframe");
    expect(keys("7"), "A keyframe is an object, not 7.");
    expect(keys(R"({"frame": 3, "position": [0, 0, 1]})"), "\"target\" is missing");
    expect(keys(good + R"(, {"frame": 4, "position": [0, "x", 1], "target": [0, 0, 0]})"), "reading keyframe 1");
    expect(keys(R"({"frame": 0, "position": [0, 1e300, 1], "target": [0, 0, 0]})"),
           "\"position\" must be three numbers");
    expect(keys(R"({"frame": 0.5, "position": [0, 0, 1], "target": [0, 0, 0]})"), "\"frame\" must be a whole number");
    expect(keys(R"({"frame": -1000001, "position": [0, 0, 1], "target": [0, 0, 0]})"),
           "\"frame\" must be a whole number");
    expect(keys(R"({"frame": 18446744073709551615, "position": [0, 0, 1], "target": [0, 0, 0]})"),
           "\"frame\" must be a whole number");
    expect(keys(R"({"frame": 1e9, "position": [0, 0, 1], "target": [0, 0, 0]})"), "\"frame\" must be a whole number");
    expect(keys(good + "," + good), "Frame 3 does not come after");
    expect(keys(R"({"frame": 0, "position": [0, 0, 1], "target": [0, 0, 0], "yfov": 180})"),
           "\"yfov\" must be an angle");
    expect(keys(R"({"frame": 0, "position": [0, 0, 1], "target": [0, 0, 0], "fov": 60})"), "There is no \"fov\"");
    expect(keys(R"({"frame": 0, "position": [0, 0, 1], "target": [0, 0, 1]})"), "At frame 0 the camera stands at");
    expect(keys(R"({"frame": 0, "position": [0, 3, 0], "target": [0, 0, 0]})"),
           "At frame 0 the camera looks along its up");
    // Sound keyframes, but halfway the camera runs through what it looks at.
    expect(keys(R"({"frame": 0, "position": [-1, 0, 0], "target": [0, 0, 0]},)"
                R"({"frame": 2, "position": [1, 0, 0], "target": [0, 0, 0]})"),
           "At frame 1 the camera stands at");
    EXPECT_EQ(messageOf(keys(good)), "no error");
}

// JSON's text has no such numbers, but an object may come from elsewhere.
TEST(CameraPath, RefusesNumbersThatAreNone)
{
    const Json good = {{"frame", 3u}, {"position", {0, 0, 1}}, {"target", {0, 0, 0}}, {"up", {0, 1, 0}}, {"yfov", 40}};
    ASSERT_NO_THROW(passes::cameraPath({{"keyframes", {good}}}, baseCamera(), {}));
    for (const double none : {std::nan(""), HUGE_VAL, -HUGE_VAL})
        for (const auto& [name, value] : good.items()) {
            Json key = good;
            (value.is_array() ? key[name][1] : key[name]) = none;
            EXPECT_THROW(passes::cameraPath({{"keyframes", {key}}}, baseCamera(), {}), Error) << name << none;
        }
}

TEST(CameraPath, AFileThatIsNoJsonIsNamed)
{
    const std::string file = testing::TempDir() + "camera_path_test.json";
    std::ofstream(file) << "{";
    try {
        passes::loadCameraPath(file, baseCamera(), {});
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
    }
}

TEST(CameraOrbit, KeepsHeightDistanceAndTarget)
{
    const scene::Camera base = baseCamera();
    const CameraAt at = passes::cameraOrbit(base, 1.5);
    for (const uint64_t frame : {0u, 1u, 60u, 239u}) {
        const scene::Camera camera = at(frame);
        EXPECT_NEAR(camera.position.y, base.position.y, 1e-12);
        EXPECT_NEAR(glm::distance(camera.position, base.target), glm::distance(base.position, base.target), 1e-12);
        expectFrame(camera);
    }
    EXPECT_NEAR(glm::distance(at(240).position, base.position), 0, 1e-12); // all the way around
    // A quarter, counter-clockwise from above: from +z over the target to +x.
    EXPECT_NEAR(glm::distance(at(60).position, glm::dvec3(6, 2, 1)), 0, 1e-12);
}
