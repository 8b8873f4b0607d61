// The three toggles, the camera, the screenshot.

#include "engine/image/image.h"
#include "tests/ui/window/window_fixture.h"

#include <fmt/format.h>

namespace
{

class Window : public WindowTest
{
};

} // namespace

TEST_F(Window, TogglesChangeWhatRunsAndItClosesCleanly)
{
    view();
    ASSERT_TRUE(comes(runs("method", "pt")));
    ASSERT_TRUE(until(runs("method", "rgb-restir"), [&] { click("method.2"); }));
    EXPECT_EQ(report()["variant"]["RESERVOIR_COUNT"], "3");
    ASSERT_TRUE(until(runs("method", "restir-pt"), [&] { click("method.1"); }));
    EXPECT_EQ(report()["variant"]["RESERVOIR_COUNT"], "1");
    ASSERT_TRUE(until(runs("shift", "replay"), [&] { click("shift.0"); }));
    const Json place = report()["places"]["max-confidence"];
    EXPECT_TRUE(until(runs("max-confidence", 1048576), [&] {
        shell(
            fmt::format("xdotool search --name Trichrome windowfocus sleep 0.2 mousemove {} {} sleep 0.3 keydown ctrl "
                        "sleep 0.3 mousedown 1 sleep 0.3 "
                        "mouseup 1 sleep 0.3 keyup ctrl sleep 0.3 key ctrl+a sleep 0.3 type --delay 150 1048576",
                        place[0].get<int>(), place[1].get<int>()));
        shell("xdotool sleep 0.2 key Return");
    }));
    EXPECT_TRUE(dragUntilMoved());
    EXPECT_EQ(close(), 0);
}

TEST_F(Window, TheLineOfAScreenshotGivesTheSamePixels)
{
    view({"--method", "rgb-restir"});
    ASSERT_TRUE(comes(runs("method", "rgb-restir")));
    ASSERT_TRUE(dragUntilMoved());
    ASSERT_TRUE(comes([](const Json& json) { return json["frames"] > 2; }));
    click("pause");
    key("F12");
    ASSERT_TRUE(comes([](const Json& json) { return json["line"] != ""; })) << "no line";
    std::string line = report()["line"];
    ASSERT_EQ(close(), 0);
    ASSERT_EQ(line.substr(0, 10), "trichrome ");
    line.replace(0, 9, TRICHROME);
    ASSERT_EQ(shell("cd " + folder_ + " && " + line), 0) << line;
    const image::Image kept = image::read(folder_ + "/trichrome-1.exr").image;
    const image::Image again = image::read(folder_ + "/trichrome-1-again.exr").image;
    EXPECT_EQ(kept.width, 64u);
    EXPECT_TRUE(kept.pixels == again.pixels);
}
