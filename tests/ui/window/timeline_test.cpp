// Scenes that move, under a person's hands.
// Covers ui/window/timeline_room.cpp.

#include "tests/support/tiny_gltf.h"
#include "tests/ui/window/window_fixture.h"

namespace
{

class Timeline : public WindowTest
{
  protected:
    // A triangle that moves 1 m a second, and comes back; a lamp and a camera before it.
    Timeline()
    {
        file_.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
        file_.json["nodes"].push_back({{"camera", 0}, {"translation", {0.4, 0.4, 2}}});
        file_.json["scenes"][0]["nodes"].push_back(1);
        file_.animate({{"node", 0}, {"path", "translation"}}, {0, 2, 4}, {0, 0, 0, 2, 0, 0, 0, 0, 0}, "VEC3");
        file_.json["animations"][0]["name"] = "to and fro";
        file_.load(); // writes it
    }
    std::string scene() const { return (file_.folder / "tiny.gltf").string(); }

    static bool shows(const Json& json) { return json["frames"] > 0; } // a picture

    TinyGltf file_;
};

} // namespace

TEST_F(Timeline, ASceneWithoutAnimationsHasNone)
{
    view();
    ASSERT_TRUE(comes(runs("method", "pt")));
    EXPECT_FALSE(report()["places"].contains("timeline"));
    EXPECT_TRUE(report()["scene_seconds"].is_null());
    EXPECT_EQ(close(), 0);
}

TEST_F(Timeline, PlaysStopsStepsScrubsAndReturnsToRest)
{
    view({}, scene());
    ASSERT_TRUE(comes([](const Json& json) { return shows(json) && json["places"].contains("timeline"); }));
    EXPECT_TRUE(report()["scene_seconds"].is_null());
    ASSERT_TRUE(until(asks("playing", true), [&] { click("play"); }));
    ASSERT_TRUE(comes([](const Json& json) { return json["playing"] == true && json["scene_seconds"] > 0.2; }));
    const double before = report()["scene_seconds"];
    ASSERT_TRUE(comes([&](const Json& json) { return json["scene_seconds"] != before; }));

    ASSERT_TRUE(until(asks("playing", false), [&] { key("t"); }));
    ASSERT_TRUE(comes([](const Json& json) { return json["playing"] == false && json["frames"] > 2; }));
    const double stopped = report()["asked"]["time"];
    ASSERT_TRUE(comes([](const Json& json) { return json["frames"] > 5; }));
    EXPECT_EQ(report()["scene_seconds"], stopped);

    // The middle of the slider is the middle of the animation.
    ASSERT_TRUE(until([](const Json& json) { return std::abs(json["asked"]["time"].get<double>() - 2) < 0.05; },
                      [&] { click("timeline"); }));
    const double middle = report()["asked"]["time"];
    ASSERT_TRUE(comes([&](const Json& json) { return json["scene_seconds"] == middle; }));
    ASSERT_TRUE(until([&](const Json& json) { return json["asked"]["time"] != middle; }, [&] { key("period"); }));
    const double steps = (report()["asked"]["time"].get<double>() - middle) * 30;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    EXPECT_GE(steps, 0.99);

    ASSERT_TRUE(until([](const Json& json) { return json["asked"]["time"].is_null(); }, [&] { click("rest"); }));
    EXPECT_TRUE(comes([](const Json& json) { return json["scene_seconds"].is_null() && json["frames"] > 0; }));
    EXPECT_EQ(close(), 0);
}

TEST_F(Timeline, BeginsWhereTheCommandLineSaysAndEndsWhereItDoesNotLoop)
{
    view({"--time", "3.5", "--fps", "10", "--loop", "off"}, scene());
    // Five frames to the end, which a report may not see.
    ASSERT_TRUE(comes([](const Json& json) { return json["playing"] == false && json["scene_seconds"] == 4; }));
    ASSERT_TRUE(comes([](const Json& json) { return json["frames"] > 1; })); // it rests there
    EXPECT_EQ(close(), 0);
    view({"--time", "1.5", "--animation", "to and fro"}, scene());
    ASSERT_TRUE(comes(shows));
    EXPECT_EQ(report()["playing"], false);
    EXPECT_EQ(report()["scene_seconds"], 1.5);
    EXPECT_EQ(close(), 0);
}

// Stopped, the mean of frames of one time; paused while it plays, the last of frames that each show another.
TEST_F(Timeline, TheLineOfAScreenshotGivesTheSamePixels)
{
    view({"--time", "0.25", "--fps", "8", "--speed", "0.5", "--method", "rgb-restir"}, scene());
    ASSERT_TRUE(comes([](const Json& json) { return shows(json) && json["frames"] > 3; }));
    ASSERT_TRUE(until(asks("paused", true), [&] { click("pause"); }));
    ASSERT_TRUE(comes([](const Json& json) { return json["paused"] == true; }));
    EXPECT_EQ(report()["settings"]["time"], "0.25");
    EXPECT_EQ(report()["settings"]["fps"], "8");
    expectTheLineGivesTheSamePixels(1);
    ASSERT_TRUE(until(asks("playing", false), [&] { key("t"); }));
    ASSERT_TRUE(until(asks("paused", false), [&] { click("pause"); }));
    ASSERT_TRUE(comes([](const Json& json) { return json["playing"] == false && json["frames"] > 3; }));
    ASSERT_TRUE(until(asks("paused", true), [&] { click("pause"); }));
    ASSERT_TRUE(comes([](const Json& json) { return json["paused"] == true; }));
    expectTheLineGivesTheSamePixels(2);
    EXPECT_EQ(close(), 0);
}
