// False colors, the pixel under the mouse, changed shaders, and that the Vulkan layers have nothing to say.

#include "tests/support/program.h"
#include "tests/ui/window/window_fixture.h"

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
TEST_F(InspectWindow, ReservoirsAreReadWhenAskedForAndTheLayersAreSilent)
{
    const bool layers = std::filesystem::exists("/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json");
    if (layers) {
        setenv("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation", 1);
        setenv("VK_LAYER_ENABLES", "VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT", 1);
    }
    view({"--method", "rgb-restir", "--spatial", "0", "--max-confidence", "5", "--shift", "replay"});
    unsetenv("VK_INSTANCE_LAYERS");
    unsetenv("VK_LAYER_ENABLES");
    ASSERT_TRUE(comes(runs("method", "rgb-restir")));
    EXPECT_EQ(report()["reservoirs"], 0);
    if (layers) {
        EXPECT_EQ(shell(fmt::format("grep -q VkLayer_khronos_validation /proc/{}/maps", window_)), 0);
    }
    ASSERT_TRUE(until(asks("pixel", true), [] { key("i"); }));
    ASSERT_TRUE(comes([](const Json& json) { return json.value("reservoirs", 0) == 3; }));
    EXPECT_TRUE(comes([](const Json& json) { return json.value("inspected", Json()) == Json({6, 6, 6}); }));

    const auto colorsShown = [&] {
        const Screen picture = screen();
        std::set<int> shown;
        for (int y = 300; y < 560; y += 7)
            for (int x = 640; x < 1040; x += 7) {
                const glm::u8vec3 p = picture.at(x, y);
                shown.insert(p.r << 16 | p.g << 8 | p.b);
            }
        return shown.size();
    };
    EXPECT_GT(colorsShown(), 100u); // a picture
    // A slow machine may take two keys at once and leave a view out: round and round until all were there.
    std::set<int> seen;
    int view = 0;
    for (int press = 0; press < 60 && (seen.size() < 7 || view != 6); ++press) {
        key("x");
        shell("sleep 0.5");
        view = report()["view"]["false_color"];
        seen.insert(view);
    }
    ASSERT_EQ(seen.size(), 7u);
    ASSERT_EQ(view, 6);
    shell("sleep 0.3");
    EXPECT_LT(colorsShown(), 12u); // nothing is not finite: one dark gray, and the mouse
    ASSERT_TRUE(until([&](const Json& json) { return json["view"]["false_color"] == 0; }, [] { key("x"); }));
    ASSERT_TRUE(until(asks("pixel", false), [] { key("i"); }));
    ASSERT_TRUE(comes([](const Json& json) { return json.value("reservoirs", 3) == 0; }));
    ASSERT_TRUE(until(asks("comparing", true), [] { key("c"); }));
    ASSERT_TRUE(comes([](const Json& json) { return json.contains("b"); }));
    ASSERT_EQ(shell("xdotool search --name Trichrome windowsize 900 500"), 0);
    const int frames = report()["frames"];
    EXPECT_TRUE(comes([&](const Json& json) { return json["frames"] > frames; }));
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
    const std::string line = "color[index] = vec4(radiance, 0.0);";
    ASSERT_NE(red.find(line), std::string::npos);
    red.replace(red.find(line), line.size(), "color[index] = vec4(8.0, 0.0, 0.0, 0.0);");
    writeFile(file, red);
    EXPECT_TRUE(comes([&](const Json&) { return middle().r > 200 && middle().g == 0; }));
    EXPECT_EQ(close(), 0);
}
