// What people expect of any window: presets, undo, dropped files, bookmarks, and that it remembers.

#include <fmt/format.h>

#include "tests/support/program.h"
#include "tests/support/tiny_gltf.h"
#include "tests/ui/window/window_fixture.h"
#include "tests/ui/window/x_client.h"

namespace
{

class WindowHabits : public WindowTest
{
};

} // namespace

TEST_F(WindowHabits, PresetsAndDropsSetWhatTheyNameAndUndoTakesItBack)
{
    writeFile(folder_ + "/mine.json", R"({"max-confidence": 7, "spatial-radius": 3})");
    writeFile(folder_ + "/wrong.json", R"({"spam": 1})");
    view();
    ASSERT_TRUE(comes(runs("method", "pt")));
    ASSERT_TRUE(
        until([](const Json& json) { return json["places"].contains("preset.paper"); }, [&] { click("preset"); }));
    ASSERT_TRUE(until(asks("max-confidence", 32768), [&] { click("preset.paper"); }));
    ASSERT_TRUE(comes(runs("max-confidence", 32768)));
    EXPECT_EQ(report()["settings"]["method"], "rgb-restir");
    EXPECT_EQ(report()["settings"]["spatial"], 0);
    EXPECT_EQ(report()["settings"]["max-bounces"], 2); // it does not name it
    ASSERT_TRUE(dropFile("Trichrome", folder_ + "/mine.json"));
    ASSERT_TRUE(comes(runs("max-confidence", 7)));
    EXPECT_EQ(report()["settings"]["spatial-radius"], 3);
    EXPECT_EQ(report()["settings"]["method"], "rgb-restir");
    ASSERT_TRUE(dropFile("Trichrome", folder_ + "/wrong.json"));
    ASSERT_TRUE(
        comes([](const Json& json) { return json["message"].get<std::string>().find("spam") != std::string::npos; }));
    EXPECT_EQ(report()["settings"]["max-confidence"], 7);
    ASSERT_TRUE(until(asks("max-confidence", 32768), [&] { key("ctrl+z"); }));
    ASSERT_TRUE(until(asks("method", "pt"), [&] { key("ctrl+z"); }));
    ASSERT_TRUE(comes(runs("method", "pt")));
    ASSERT_TRUE(until(asks("method", "rgb-restir"), [&] { key("ctrl+y"); }));
    ASSERT_TRUE(comes(runs("method", "rgb-restir")));
    EXPECT_EQ(report()["settings"]["max-confidence"], 32768);
    EXPECT_EQ(close(), 0);
}

// The mouse leaves before the window has drawn a frame.
TEST_F(WindowHabits, AHastyClickCountsWhereItHappened)
{
    view();
    ASSERT_TRUE(comes(runs("method", "pt")));
    for (int i = 0; i < 6; ++i) {
        const bool paused = i % 2 == 0;
        const Json place = report()["places"]["pause"];
        shell(fmt::format("xdotool mousemove {} {} mousedown 1 mouseup 1 mousemove 900 600", place[0].get<int>(),
                          place[1].get<int>()));
        EXPECT_TRUE(comes(asks("paused", paused)));
    }
    EXPECT_EQ(close(), 0);
}

TEST_F(WindowHabits, ASceneCanBeDroppedABadOneChangesNothingAndTheRestIsRemembered)
{
    writeFile(folder_ + "/broken.gltf", "{\"asset\": ");
    view();
    ASSERT_TRUE(comes(runs("method", "pt")));
    ASSERT_TRUE(dragUntilMoved());
    ASSERT_TRUE(
        until([](const Json& json) { return json["message"] == "Bookmark 1 is here."; }, [&] { key("ctrl+1"); }));
    ASSERT_TRUE(until(asks("moved", false), [&] { key("Home"); }));
    ASSERT_TRUE(until(asks("moved", true), [&] { key("1"); }));

    ASSERT_TRUE(dropFile("Trichrome", folder_ + "/broken.gltf"));
    ASSERT_TRUE(comes([](const Json& json) {
        return json["message"].get<std::string>().find("broken.gltf") != std::string::npos && json["frames"] > 0;
    }));
    const int frames = report()["frames"];
    EXPECT_TRUE(comes([&](const Json& json) { return json["scene"] == "cornell" && json["frames"] > frames; }));
    ASSERT_EQ(shell("xdotool search --name Trichrome windowsize 1000 600"), 0);
    ASSERT_EQ(shell("xdotool search --name Trichrome windowunmap sleep 0.5 windowmap"), 0);
    EXPECT_TRUE(comes([&, later = report()["frames"].get<int>()](const Json& json) { return json["frames"] > later; }));
    ASSERT_EQ(close(), 0);

    view({}, "furnace");
    ASSERT_TRUE(comes([](const Json& json) { return json["scene"] == "furnace"; }));
    EXPECT_EQ(report()["recent"], Json({"furnace", "cornell"}));
    const Json kept = readJson(folder_ + "/trichrome/window.json");
    EXPECT_EQ(kept["size"], Json({1000, 600}));
    EXPECT_TRUE(kept["bookmarks"]["cornell"][0].is_object());
    ASSERT_TRUE(until([](const Json& json) { return json["places"].contains("recent.1"); }, [&] { click("open"); }));
    EXPECT_TRUE(until([](const Json& json) { return json["scene"] == "cornell"; }, [&] { click("recent.1"); }));
    EXPECT_EQ(close(), 0);
}

// --time is of the scene on the command line alone; what the loader says of a scene is shown for as long as it is open.
TEST_F(WindowHabits, ASceneOpenedLaterIsAtRestAndItsWarningsAreShown)
{
    TinyGltf file;
    file.animate({{"node", 0}, {"path", "translation"}}, {0, 2}, {0, 0, 0, 9, 0, 0}, "VEC3");
    file.load(); // writes it
    const std::string scene = (file.folder / "tiny.gltf").string();
    view();
    ASSERT_TRUE(comes(runs("method", "pt")));
    EXPECT_EQ(report()["message"], "");
    ASSERT_EQ(close(), 0);

    view({"--time", "0.5"}, scene);
    ASSERT_TRUE(comes(runs("time", "0.5")));
    std::string message = report()["message"];
    EXPECT_NE(message.find("The file has no camera"), std::string::npos) << message;
    EXPECT_NE(message.find("The file has no light"), std::string::npos) << message;
    EXPECT_EQ(message.find("at rest"), std::string::npos) << message;
    ASSERT_TRUE(dropFile("Trichrome", scene));
    ASSERT_TRUE(comes([](const Json& json) { return !json["settings"].contains("time") && json["frames"] > 0; }));
    message = report()["message"];
    EXPECT_NE(message.find("The file has no light"), std::string::npos) << message;
    EXPECT_EQ(message.find("at rest"), std::string::npos) << message; // the timeline says it
    ASSERT_TRUE(until([](const Json& json) { return json["places"].contains("recent.1"); }, [&] { click("open"); }));
    ASSERT_TRUE(until([](const Json& json) { return json["scene"] == "cornell"; }, [&] { click("recent.1"); }));
    EXPECT_EQ(report()["message"], "");
    EXPECT_EQ(close(), 0);
}

TEST_F(WindowHabits, ASceneThatFailsAtFirstLeavesTheWindowOpen)
{
    view({}, "missing.glb");
    EXPECT_TRUE(comes([](const Json& json) {
        return json.contains("message") && json["message"].get<std::string>().find("missing.glb") != std::string::npos;
    }));
    EXPECT_EQ(close(), 0);
}
