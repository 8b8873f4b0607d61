// Camera paths, recorded and played, and the films of them.
// Covers ui/window/path_room.cpp.

#include "engine/image/image.h"
#include "tests/support/program.h"
#include "tests/support/tiny_gltf.h"
#include "tests/ui/window/window_fixture.h"

#include <filesystem>

#include <fmt/format.h>

namespace
{

class CameraPath : public WindowTest
{
  protected:
    static size_t keyframes(const Json& json) { return json["asked"]["keyframes"].size(); }

    // Paused while it plays, somewhere in between: where it is, or a few frames on, which come one by one.
    void stopBetween(int low, int high) const
    {
        ASSERT_TRUE(until(
            [&](const Json& json) {
                return json["asked"]["paused"] == true && json["paused"] == true && json["playing"] == true &&
                       json["frame"] >= low && json["frame"] <= high;
            },
            [&] { key("n"); }));
    }

    // The picture of the last F12 is that frame of the film.
    void expectFrameOfFilm(int screenshot, int film, int frame) const
    {
        const auto read = [&](const std::string& file) { return image::read(folder_ + "/" + file).image.pixels; };
        EXPECT_TRUE(read(fmt::format("trichrome-{}.png", screenshot)) ==
                    read(fmt::format("trichrome-film-{}/{:04}.png", film, frame)));
    }

    std::string film() const
    {
        EXPECT_TRUE(until(
            [&](const Json& json) { return json["line"].get<std::string>().find("--sequence") != std::string::npos; },
            [&] { key("F11"); }));
        return report()["line"];
    }
};

} // namespace

// In a scene that rests: frames alone move the camera.
TEST_F(CameraPath, IsRecordedPlaysAndBecomesAFilmOfTheSamePixels)
{
    view({"--fps", "8"});
    ASSERT_TRUE(comes(runs("method", "pt")));
    EXPECT_FALSE(report()["places"].contains("frame"));
    ASSERT_TRUE(until(
        [](const Json& json) { return json["message"].get<std::string>().find("Nothing moves") != std::string::npos; },
        [&] { key("F11"); }));
    ASSERT_TRUE(until([](const Json& json) { return keyframes(json) == 1; }, [&] { key("m"); }));
    EXPECT_EQ(report()["asked"]["frame"], 8); // a second later
    EXPECT_EQ(report()["asked"]["moved"], false);
    ASSERT_TRUE(dragUntilMoved());
    ASSERT_TRUE(until([](const Json& json) { return keyframes(json) == 2; }, [&] { click("add-keyframe"); }));
    EXPECT_EQ(report()["asked"]["keyframes"], Json({0, 8}));

    ASSERT_TRUE(until(asks("playing", true), [&] { key("t"); }));
    ASSERT_TRUE(comes([](const Json& json) { return json["playing"] == true && json["camera_moved"] == false; }));
    stopBetween(1, 7);
    const int frame = report()["frame"];
    expectTheLineGivesTheSamePixels(1);
    const std::string line = film();
    EXPECT_NE(line.find("--sequence 0:9 "), std::string::npos) << line;
    EXPECT_EQ(line.find("--fps"), std::string::npos) << line;
    ASSERT_EQ(runLine(line), 0) << line;
    EXPECT_TRUE(std::filesystem::exists(folder_ + "/trichrome-film-1/0008.png"));
    EXPECT_FALSE(std::filesystem::exists(folder_ + "/trichrome-film-1/0009.png"));
    expectFrameOfFilm(1, 1, frame);

    // Stopped, it stays where it was, and frames are averaged.
    ASSERT_TRUE(until(asks("playing", false), [&] { key("t"); }));
    ASSERT_TRUE(until(asks("paused", false), [&] { click("pause"); }));
    ASSERT_TRUE(comes([](const Json& json) { return json["playing"] == false && json["frames"] > 3; }));
    EXPECT_EQ(report()["asked"]["frame"], frame);
    EXPECT_EQ(report()["camera_moved"], true);
    ASSERT_TRUE(until(asks("paused", true), [&] { click("pause"); }));
    expectTheLineGivesTheSamePixels(2);
    const Json still = readJson(folder_ + "/trichrome-2.camera.json")["keyframes"];
    EXPECT_EQ(still.size(), 1u);

    for (const int number : {1, 2}) {
        const std::string file = fmt::format("{}/trichrome-path-{}.json", folder_, number);
        ASSERT_TRUE(until([&](const Json&) { return std::filesystem::exists(file); }, [&] { click("save-path"); }));
        EXPECT_EQ(readJson(file), readJson(folder_ + "/trichrome-film-1/camera.json"));
    }
    ASSERT_TRUE(until(asks("frame", 8), [&] {
        const auto open = [](const Json& json) { return json["places"].contains("keyframe.8"); };
        if (!open(report())) click("keyframes"); // a list closes when the mouse misses it
        ASSERT_TRUE(comes(open));
        click("keyframe.8");
    }));
    ASSERT_TRUE(until([](const Json& json) { return json["asked"]["keyframes"] == Json::array({0}); },
                      [&] { click("remove-keyframe"); }));
    ASSERT_TRUE(until([](const Json& json) { return keyframes(json) == 0; }, [&] { click("clear-path"); }));
    EXPECT_TRUE(comes([](const Json& json) { return !json["places"].contains("frame"); }));
    EXPECT_EQ(close(), 0);
}

// Opened like `render`: scene and camera move together. Where it starts over on its way, the rest of the path is kept.
TEST_F(CameraPath, IsOpenedAndPlaysWithTheScene)
{
    TinyGltf file;
    file.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
    file.json["nodes"].push_back({{"camera", 0}, {"translation", {0.4, 0.4, 2}}});
    file.json["scenes"][0]["nodes"].push_back(1);
    file.animate({{"node", 0}, {"path", "translation"}}, {0, 2, 4}, {0, 0, 0, 2, 0, 0, 0, 0, 0}, "VEC3");
    file.load(); // writes it
    writeFile(folder_ + "/way.json", R"({"keyframes": [
        {"frame": 0, "position": [0.1, 0.4, 2], "target": [0.3, 0.3, 0]},
        {"frame": 40, "position": [0.9, 0.2, 2.5], "target": [0.4, 0.3, 0.1]},
        {"frame": 60, "position": [1.1, 0.7, 1.5], "target": [0.5, 0.3, 0.1]}]})");
    view({"--camera-path", "way.json", "--time", "0.25", "--fps", "8", "--speed", "0.5", "--method", "restir-pt",
          "--shift", "replay", "--spatial", "0"},
         (file.folder / "tiny.gltf").string());
    ASSERT_TRUE(comes([](const Json& json) { return json["playing"] == true && json["frame"] > 1; }));
    EXPECT_EQ(report()["asked"]["keyframes"], Json({0, 40, 60}));
    stopBetween(2, 50);
    const Json shown = report();
    EXPECT_EQ(shown["scene_seconds"].get<double>(), 0.25 + shown["frame"].get<int>() * 0.0625);
    screenshot(1);
    const std::string line = film();
    EXPECT_NE(line.find("--time 0.25 --fps 8 --speed 0.5 --loop on"), std::string::npos) << line;
    ASSERT_EQ(runLine(line), 0) << line;
    expectFrameOfFilm(1, 1, shown["frame"]);

    ASSERT_TRUE(until([](const Json& json) { return json["frames"] < json["frame"]; }, [&] { key("r"); }));
    ASSERT_TRUE(until([&](const Json& json) { return json["frame"] > shown["frame"]; }, [&] { key("n"); }));
    EXPECT_LT(report()["frames"], report()["frame"]);
    expectTheLineGivesTheSamePixels(2);
    EXPECT_EQ(close(), 0);
}
