// render --sequence, and scenes that play (--fps), as a person would use them.
// Covers ui/cli/sequence_output.cpp, ui/cli/motion_options.cpp.

#include "tests/support/trichrome.h"

#include "engine/image/image.h"
#include "tests/support/tiny_gltf.h"

namespace
{

class Sequences : public Trichrome
{
  protected:
    // A triangle that shines, slides out of sight in 2 s, and is what there is to see at the picture's middle.
    Sequences()
    {
        file.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
        file.json["nodes"].push_back({{"camera", 0}, {"translation", {0.4, 0.4, 2}}});
        file.json["scenes"][0]["nodes"].push_back(1);
        file.material()["emissiveFactor"] = {1, 1, 1};
        file.animate({{"node", 0}, {"path", "translation"}}, {0, 2}, {0, 0, 0, 9, 0, 0}, "VEC3");
        file.load();
    }

    std::vector<std::string> command(const std::string& output, const std::vector<std::string>& more) const
    {
        std::vector<std::string> words = {"render", (file.folder / "tiny.gltf").string(), "-o", directory / output};
        words.insert(words.end(), {"--size", "16x16", "--max-bounces", "2"});
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    std::vector<glm::vec3> pixels(const std::string& name) const { return image::read(directory / name).image.pixels; }

    TinyGltf file;
};

constexpr size_t MIDDLE = 8 * 16 + 7;
const glm::vec3 DARK(0), LIT(1);

} // namespace

TEST_F(Sequences, WriteEveryFrameOfAScene)
{
    runWell(command("%04d.exr", {"--sequence", "0:4", "--fps", "1"}));
    for (const auto& [name, color] :
         {std::pair("0000.exr", LIT), {"0001.exr", DARK}, {"0002.exr", LIT}, {"0003.exr", DARK}})
        EXPECT_EQ(pixels(name)[MIDDLE], color) << name; // at 2 s it begins again
    EXPECT_FALSE(std::filesystem::exists(directory / "0004.exr"));

    runWell(command("%d.exr", {"--sequence", "0:4", "--fps", "1", "--loop", "off"}));
    for (const auto& [name, color] : {std::pair("0.exr", LIT), {"1.exr", DARK}, {"2.exr", DARK}, {"3.exr", DARK}})
        EXPECT_EQ(pixels(name)[MIDDLE], color) << name;

    runWell(command("%d.exr", {"--sequence", "0:2", "--fps", "1", "--time", "1", "--speed", "-1"}));
    EXPECT_EQ(pixels("0.exr")[MIDDLE], DARK);
    EXPECT_EQ(pixels("1.exr")[MIDDLE], LIT);
}

TEST_F(Sequences, AreTheFramesThatOneRenderWouldEndWith)
{
    for (const std::string method : {"pt", "rgb-restir"}) {
        const std::vector<std::string> play = {"--fps", "8", "--method", method};
        const auto with = [&](std::vector<std::string> words) {
            words.insert(words.end(), play.begin(), play.end());
            return words;
        };
        runWell(command("%d.exr", with({"--sequence", "0:4"})));
        runWell(command("end.exr", with({"--frames", "3"})));
        EXPECT_EQ(pixels("2.exr"), pixels("end.exr")) << method;
        runWell(command("late%d.exr", with({"--sequence", "2:3", "--warm-up", "2"})));
        EXPECT_EQ(pixels("2.exr"), pixels("late2.exr")) << method;
        EXPECT_FALSE(std::filesystem::exists(directory / "late1.exr"));
        EXPECT_NE(pixels("2.exr"), pixels("3.exr")) << method;
    }
    runWell(command("still.exr", {"--time", "0.25", "--animation", "all"}));
    runWell(command("end.exr", {"--fps", "8", "--frames", "3", "--method", "pt"}));
    EXPECT_EQ(pixels("still.exr"), pixels("end.exr")); // what it sees shines alike in every frame
}

// --restart: chains of two frames, each what it is without the others, and other than without a restart.
TEST_F(Sequences, RestartAsIfEachChainWereRenderedAlone)
{
    const auto flags = [&](const std::string& name, const std::string& range, std::vector<std::string> more) {
        more.insert(more.end(), {"--sequence", range, "--fps", "2", "--warm-up", "1"});
        std::vector<std::string> words = command(name + "%d.exr", more);
        words[1] = "flags";
        runWell(words);
    };
    std::vector<std::string> method = {"--method", "restir-pt", "--shift", "replay", "--spatial", "0"};
    flags("whole", "1:5", method);
    method.insert(method.end(), {"--restart", "2"});
    flags("restarting", "1:6", method);
    flags("chain", "3:5", method);
    EXPECT_EQ(pixels("whole2.exr"), pixels("restarting2.exr"));
    for (const std::string frame : {"3.exr", "4.exr"}) {
        EXPECT_EQ(pixels("chain" + frame), pixels("restarting" + frame)) << frame;
        EXPECT_NE(pixels("whole" + frame), pixels("restarting" + frame)) << frame;
    }

    // What has no history needs no warm-up, and every frame is a chain.
    flags("whole", "1:3", {"--method", "pt"});
    flags("chain", "2:3", {"--method", "pt"});
    EXPECT_EQ(pixels("chain2.exr"), pixels("whole2.exr"));
    EXPECT_FALSE(std::filesystem::exists(directory / "whole0.exr"));
}

TEST_F(Sequences, GoOnFromACheckpointToTheSameBits)
{
    const std::string checkpoint = directory / "x.ckpt";
    const std::vector<std::string> play = {"--fps", "8", "--method", "rgb-restir", "--warm-up", "1"};
    using Words = std::vector<std::string>;
    // Within a chain, and into the next one.
    for (const Words& chains : {Words{}, Words{"--restart", "3", "--shift", "replay", "--spatial", "0"}}) {
        const auto with = [&](std::vector<std::string> words) {
            words.insert(words.end(), play.begin(), play.end());
            words.insert(words.end(), chains.begin(), chains.end());
            return words;
        };
        runWell(command("whole%d.exr", with({"--sequence", "1:6"})));
        runWell(command("part%d.exr", with({"--sequence", "1:3", "--checkpoint", checkpoint})));
        runWell(command("part%d.exr", with({"--sequence", "1:6", "--resume", checkpoint})));
        for (const std::string frame : {"1.exr", "2.exr", "3.exr", "4.exr", "5.exr"})
            EXPECT_EQ(pixels("whole" + frame), pixels("part" + frame)) << chains.size();
    }
    expectRefusal(command("%d.exr", {"--sequence", "1:6", "--fps", "8", "--method", "rgb-restir", "--warm-up", "1",
                                     "--shift", "replay", "--spatial", "0", "--restart", "2", "--resume", checkpoint}),
                  1, "its restart is \"3\", not \"2\"");
    expectRefusal(command("%d.exr", {"--sequence", "0:6", "--fps", "9", "--resume", checkpoint}), 1, "Cannot resume");
}

TEST_F(Sequences, RefuseWhatMakesNoSense)
{
    const auto refuses = [&](const std::string& output, const std::vector<std::string>& more, const std::string& part) {
        expectRefusal(command(output, more), 2, part);
    };
    for (const std::string range : {"5", "3:3", "4:2", "-1:2", "0:9999999", "a:b", "0:1:2", "1.5:2"})
        refuses("%d.png", {"--sequence", range}, "is no range of frames");
    for (const std::string output : {"x.png", "%s.png", "%d%d.png", "%x.png"})
        refuses(output, {"--sequence", "0:2"}, "must say once where its number goes");
    refuses("%d.bmp", {"--sequence", "0:2"}, "bmp");
    refuses("%d.png", {"--sequence", "0:2", "--frames", "3"}, "--frames cannot be combined with --sequence");
    refuses("%d.png", {"--sequence", "0:2", "--average", "on"}, "--average on cannot be combined with --sequence");
    refuses("%d.exr", {"--sequence", "0:2", "--layers", "mean"}, "--layers mean cannot be combined with --sequence");
    refuses("%d.png", {"--sequence", "0:999999", "--method", "restir-pt", "--restart", "1", "--warm-up", "10000"},
            "makes 10000989999 frames");
    refuses("x.png", {"--restart", "-1"}, "--restart");
    refuses("x.png", {"--fps", "5", "--average", "on"}, "--average on cannot be combined with --fps");
    refuses("x.png", {"--fps", "5", "--animation", "off"}, "leave out one of the two");
    refuses("x.png", {"--speed", "2"}, "--fps");
    refuses("x.png", {"--fps", "nan"}, "--fps");
    runWell(command("1.exr", {"--time", "0"}));
    const std::vector<glm::vec3> before = pixels("1.exr");
    refuses("%d.exr", {"--sequence", "0:3", "--time", "0", "--environment", directory / "1.exr"},
            "--output would write over");
    refuses("%d.exr", {"--sequence", "0:3", "--time", "0", "--stats", directory / "1.exr"},
            "would both write the file");
    EXPECT_EQ(pixels("1.exr"), before);
    EXPECT_FALSE(std::filesystem::exists(directory / "0.exr"));
    expectRefusal(command("none/%d.png", {"--sequence", "0:2"}), 1, "none");
}
