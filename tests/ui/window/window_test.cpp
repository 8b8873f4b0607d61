// The three toggles, the camera, the screenshot, and what the window draws into being lost.
// Covers ui/commands/view.cpp, ui/window/camera_hands.cpp, ui/window/frame.cpp, ui/window/mouse.cpp,
// ui/window/panel.cpp, ui/window/pose.cpp, ui/window/presenter.cpp, ui/window/presenter_setup.cpp,
// ui/window/screenshot.cpp, ui/window/widgets.cpp, ui/window/window_report.cpp.

#include "engine/image/image.h"
#include "tests/support/program.h"
#include "tests/ui/window/window_fixture.h"
#include "tests/ui/window/x_client.h"

#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>

namespace
{

class Window : public WindowTest
{
};

class FineDisplay : public WindowTest
{
  protected:
    FineDisplay() { serverWords_ = {"-screen", "0", "2560x1440x24"}; }
};

} // namespace

TEST_F(Window, TogglesChangeWhatRunsAndTheLineOfAScreenshotGivesTheSamePixels)
{
    view({"--spatial", "0"});
    ASSERT_TRUE(comes(runs("method", "pt")));
    ASSERT_TRUE(until(asks("method", "restir-pt"), [&] { click("method.1"); }));
    ASSERT_TRUE(comes(runs("method", "restir-pt")));
    EXPECT_EQ(report()["variant"]["RESERVOIR_COUNT"], "1");
    ASSERT_TRUE(until(asks("shift", "replay"), [&] { click("shift.0"); }));
    ASSERT_TRUE(comes(runs("shift", "replay")));
    ASSERT_TRUE(until(asks("method", "rgb-restir"), [&] { click("method.2"); }));
    ASSERT_TRUE(comes(runs("method", "rgb-restir")));
    EXPECT_EQ(report()["variant"]["RESERVOIR_COUNT"], "3");
    const Json place = report()["places"]["max-confidence"];
    ASSERT_TRUE(until(runs("max-confidence", 1048576), [&] {
        shell(
            fmt::format("xdotool search --name Trichrome windowfocus mousemove {} {} sleep 0.1 keydown ctrl sleep 0.1 "
                        "click 1 sleep 0.1 keyup ctrl sleep 0.1 key ctrl+a sleep 0.1 type --delay 60 1048576",
                        place[0].get<int>(), place[1].get<int>()));
        shell("xdotool sleep 0.1 key Return");
    }));
    ASSERT_TRUE(dragUntilMoved());

    ASSERT_TRUE(comes([](const Json& json) { return json["frames"] > 2; }));
    ASSERT_TRUE(until(asks("paused", true), [&] { click("pause"); }));
    expectTheLineGivesTheSamePixels(1);
    EXPECT_EQ(image::read(folder_ + "/trichrome-1.exr").image.width, 64u);
    EXPECT_EQ(close(), 0);
}

// At 200% everything is twice as large, and at both scales every widget lies within the window.
TEST_F(FineDisplay, NothingIsClippedAtAnyScale)
{
    const auto look = [&](int scale) {
        setDpi(96 * scale);
        view({"--spatial", "0"});
        EXPECT_TRUE(comes(runs("method", "pt")));
        EXPECT_TRUE(until(asks("comparing", true), [&] { key("c"); }));
        EXPECT_TRUE(until(asks("pixel", true), [&] { key("i"); }));
        EXPECT_TRUE(until([](const Json& json) { return json["places"].contains("size"); },
                          [&] { click("edit.0"); })); // A's settings are the most
        Json seen = report();
        EXPECT_EQ(close(), 0);
        EXPECT_EQ(seen["scale"], double(scale));
        for (const auto& [name, place] : seen["places"].items()) {
            EXPECT_LT(place[0], scale * 1280 - 20) << name;
            EXPECT_LT(place[1], scale * (720 - 10)) << name;
        }
        return seen;
    };
    const Json one = look(1), two = look(2);
    EXPECT_EQ(one["picture"], Json({400, 112, 880, 495}));
    EXPECT_EQ(two["picture"], Json({800, 225, 1760, 990}));
    for (const auto& [name, place] : one["places"].items())
        for (const size_t i : {0u, 1u})
            EXPECT_NEAR(two["places"][name][i].get<double>(), 2 * place[i].get<double>(), 30) << name;
}

// A preloaded library loses them (lose_device.cpp).
TEST_F(Window, ALostSwapchainOrScreenIsMadeAnewAndTheFilmGoesOn)
{
    const std::string losing = folder_ + "/lose";
    setenv("LD_PRELOAD", LOSE_DEVICE, 1);
    setenv("TRICHROME_TEST_LOSE", losing.c_str(), 1);
    view();
    unsetenv("LD_PRELOAD");
    unsetenv("TRICHROME_TEST_LOSE");
    ASSERT_TRUE(comes(runs("method", "pt")));
    const auto lose = [&](const char* error) {
        writeFile(losing + ".part", error);
        std::filesystem::rename(losing + ".part", losing);
        return comes([&](const Json&) { return !std::filesystem::exists(losing); });
    };
    // Whether what the window shows still reaches the screen: without the panel, nothing bright is in its place.
    const auto panelShown = [&] {
        const Screen now = screen();
        for (int y = 0; y < 60; ++y)
            for (int x = 0; x < 300; ++x)
                if (now.at(x, y).g > 150) return true;
        return false;
    };
    ASSERT_TRUE(comes([&](const Json&) { return panelShown(); }));
    const Json before = report();

    ASSERT_TRUE(lose("-1000001004 1")); // VK_ERROR_OUT_OF_DATE_KHR
    EXPECT_TRUE(until([&](const Json&) { return !panelShown(); }, [&] { key("h"); }));
    EXPECT_EQ(report()["message"], "");

    ASSERT_TRUE(lose("-1000000000 1")); // VK_ERROR_SURFACE_LOST_KHR
    EXPECT_TRUE(comes(
        [](const Json& json) { return json["message"].get<std::string>().find("opened anew") != std::string::npos; }));
    EXPECT_TRUE(until([&](const Json&) { return panelShown(); }, [&] { key("h"); }));
    EXPECT_TRUE(comes([&](const Json& json) { return json["frames"] > before["frames"]; }));
    EXPECT_GT(report()["seconds"], before["seconds"]); // the film was never started over

    ASSERT_TRUE(lose("-4 2")); // VK_ERROR_DEVICE_LOST, twice in a row: no use
    EXPECT_EQ(waitForEnd(), 1);
    EXPECT_NE(log().find("failed in vkAcquireNextImageKHR"), std::string::npos) << log();
}
