// False colors, the pixel under the mouse, changed shaders, and that the Vulkan layers have nothing to say.
// Covers ui/window/pixel_room.cpp.

#include "tests/support/program.h"
#include "tests/ui/window/window_fixture.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include <fmt/format.h>

namespace
{

class InspectWindow : public WindowTest
{
};

} // namespace

// In a room that fills the picture every pixel of a resting camera has the same confidence: frames, at most M_c + 1.
TEST_F(InspectWindow, ReservoirsPathsAndFalseColorsAreReadWhenAskedForAndTheLayersAreSilent)
{
    const bool layers = std::filesystem::exists("/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json");
    if (layers) {
        setenv("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation", 1);
        setenv("VK_LAYER_ENABLES", "VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT", 1);
    }
    view({"--method", "rgb-restir", "--spatial", "1", "--max-confidence", "5", "--shift", "replay"});
    unsetenv("VK_INSTANCE_LAYERS");
    unsetenv("VK_LAYER_ENABLES");
    ASSERT_TRUE(comes(runs("method", "rgb-restir")));
    EXPECT_EQ(report()["reservoirs"], 0);
    if (layers) {
        EXPECT_EQ(shell(fmt::format("grep -q VkLayer_khronos_validation /proc/{}/maps", window_)), 0);
    }
    // How many pixels of the screen have the color in which the path of red's reservoir is drawn.
    const auto redOfPaths = [&] {
        const Screen picture = screen();
        return std::ranges::count(picture.pixels, glm::u8vec3(255, 64, 64));
    };
    EXPECT_EQ(redOfPaths(), 0);
    ASSERT_TRUE(until(asks("pixel", true), [&] { key("i"); }));
    ASSERT_TRUE(comes([](const Json& json) { return json.value("inspected", Json()).size() == 3; }));
    EXPECT_EQ(report()["reservoirs"], 3);
    ASSERT_TRUE(comes([&](const Json& json) {
        return json.value("path_points", Json()).size() == 3 && json["path_points"][0] >= 2 && redOfPaths() > 10;
    }));

    const auto colorsShown = [&] {
        const Screen picture = screen();
        const auto [left, top] = inPicture(0.3, 0.4);
        const auto [right, bottom] = inPicture(0.7, 0.8);
        std::set<int> shown;
        for (int y = top; y < bottom; y += 7)
            for (int x = left; x < right; x += 7) {
                const glm::u8vec3 p = picture.at(x, y);
                shown.insert(p.r << 16 | p.g << 8 | p.b);
            }
        return shown.size();
    };
    ASSERT_TRUE(until(asks("pixel", false), [&] { key("i"); }));
    EXPECT_GT(colorsShown(), 100u); // a picture
    // One view after the other. A slow machine may take two keys at once and leave a view out: then round again.
    constexpr int VIEWS = 9, BY_OUTCOME = 6, NOT_FINITE = 8;
    std::set<int> seen;
    int view = 0;
    for (int press = 0; press < 4 * VIEWS && (int(seen.size()) < VIEWS || view != NOT_FINITE); ++press) {
        ASSERT_TRUE(until([&](const Json& json) { return json["view"]["false_color"] != view; }, [&] { key("x"); }));
        view = report()["view"]["false_color"];
        seen.insert(view);
        if (view == BY_OUTCOME) {
            EXPECT_TRUE(comes([](const Json& json) { return json["shifts_read"] == 64 * 36; }));
        }
    }
    ASSERT_EQ(int(seen.size()), VIEWS);
    ASSERT_EQ(view, NOT_FINITE);
    EXPECT_TRUE(comes([&](const Json&) { return colorsShown() < 12; })); // all finite: one dark gray, and the mouse
    ASSERT_TRUE(until([&](const Json& json) { return json["view"]["false_color"] == 0; }, [&] { key("x"); }));
    ASSERT_TRUE(comes([](const Json& json) { return json.value("reservoirs", 3) == 0; }));
    ASSERT_TRUE(until(asks("comparing", true), [&] { key("c"); }));
    ASSERT_TRUE(comes([](const Json& json) { return json.contains("b"); }));
    ASSERT_EQ(shell("xdotool search --name Trichrome windowsize 900 500"), 0);
    const auto frames = [](const Json& json) { return json["frames"].get<int>() + json["b"]["frames"].get<int>(); };
    EXPECT_TRUE(
        comes([&, before = frames(report())](const Json& json) { return frames(json) > before; })); // A may wait for B
    ASSERT_EQ(close(), 0);
    EXPECT_EQ(log(), "");
}

TEST_F(InspectWindow, ChangedShadersAreTakenUpAndBrokenOnesAreRefused)
{
    const std::string shaders = folder_ + "/shaders";
    std::filesystem::copy(TRICHROME_SOURCE_DIR "/shaders", shaders, std::filesystem::copy_options::recursive);
    const std::string file = shaders + "/path_trace.comp", text = readFile(file);
    view({"--shaders", shaders});
    ASSERT_TRUE(comes(runs("method", "pt")));
    const auto middle = [&] { return screen().at(840, 320); };
    EXPECT_TRUE(comes([&](const Json&) { return middle().r > 20; }));

    writeFile(file, text + "\nspam;\n");
    ASSERT_TRUE(comes([](const Json& json) {
        return json["message"].get<std::string>().find("path_trace.comp:") != std::string::npos;
    }));
    const int frames = report()["frames"];
    EXPECT_TRUE(comes([&](const Json& json) { return json["frames"] > frames; })); // the old one goes on
    std::string red = text;
    const std::string line = "rowOf(radiance)";
    ASSERT_NE(red.find(line), std::string::npos);
    red.replace(red.find(line), line.size(), "rowOf(vec3(8.0, 0.0, 0.0))");
    writeFile(file, red);
    EXPECT_TRUE(comes([&](const Json&) { return middle().r > 200 && middle().g == 0; }));
    EXPECT_EQ(close(), 0);
}
