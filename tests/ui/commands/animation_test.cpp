// --time and --animation, as a person would use them: what they show, and what they refuse.

#include "tests/support/trichrome.h"

#include <map>

#include "engine/image/image.h"
#include "tests/support/tiny_gltf.h"

namespace
{

class AnimationOptions : public Trichrome
{
  protected:
    // A triangle that slides out of sight in 2 s; the second animation is broken.
    AnimationOptions()
    {
        file.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
        file.json["nodes"].push_back({{"camera", 0}, {"translation", {0.4, 0.4, 2}}});
        file.json["scenes"][0]["nodes"].push_back(1);
        file.material()["emissiveFactor"] = {1, 1, 1};
        file.animate({{"node", 0}, {"path", "translation"}}, {0, 2}, {0, 0, 0, 9, 0, 0}, "VEC3");
        file.json["animations"][0]["name"] = "slide";
        scene = (file.folder / "tiny.gltf").string();
    }

    void breakTimes()
    {
        nlohmann::json broken = file.json["animations"][0];
        broken["name"] = "broken";
        broken["samplers"][0]["input"] = file.accessor<float>({2, 1}, "SCALAR");
        file.json["animations"].push_back(broken);
        file.load();
    }

    std::vector<std::string> command(const std::string& output, const std::vector<std::string>& more) const
    {
        std::vector<std::string> words = {"render", scene,   "-o",       directory / output,
                                          "--size", "16x16", "--frames", "2"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }

    std::vector<glm::vec3> picture(const std::vector<std::string>& more)
    {
        const Outcome outcome = run(command("out.exr", more));
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        err = outcome.err;
        return image::read(directory / "out.exr").image.pixels;
    }

    TinyGltf file;
    std::string scene, err;
};

const glm::vec3 DARK(0), LIT(1);

} // namespace

TEST_F(AnimationOptions, ShowTheSceneAtATime)
{
    file.load();
    const size_t middle = 8 * 16 + 7;
    const std::vector<glm::vec3> rest = picture({});
    EXPECT_EQ(rest[middle], LIT);
    EXPECT_EQ(err, "Warning: The scene has 1 animation and is shown at rest: --time SECONDS shows it as it is at that "
                   "time.\n");
    EXPECT_EQ(picture({"--animation", "off"}), rest);
    EXPECT_EQ(err, "");
    for (const std::string animation : {"all", "slide", "0"}) {
        EXPECT_EQ(picture({"--time", "0", "--animation", animation}), rest);
        EXPECT_EQ(picture({"--time", "1", "--animation", animation})[middle], DARK);
        EXPECT_EQ(picture({"--animation", animation}), rest); // at its first moment
    }
    EXPECT_EQ(picture({"--time", "1e6"})[middle], DARK);
    EXPECT_EQ(err, "");
}

TEST_F(AnimationOptions, ShowBuiltInScenesAtATime)
{
    for (const std::string name : {"carousel", "flags"}) {
        scene = name;
        const std::vector<glm::vec3> rest = picture({});
        EXPECT_NE(err.find("is shown at rest"), std::string::npos) << err;
        EXPECT_EQ(picture({"--time", "0"}), rest);
        EXPECT_NE(picture({"--time", "1.3", "--animation", name}), rest);
        EXPECT_EQ(err, "");
    }
}

TEST_F(AnimationOptions, AreKeptWithThePicture)
{
    file.load();
    const std::string stats = directory / "stats.json";
    picture({"--time", "0.5", "--animation", "slide", "--stats", stats});
    const image::Metadata list = image::read(directory / "out.exr").metadata;
    const std::map<std::string, std::string> metadata(list.begin(), list.end());
    EXPECT_EQ(metadata.at("time"), "0.5");
    EXPECT_EQ(metadata.at("animation"), "slide");
    EXPECT_EQ(readJson(stats)["settings"]["time"], "0.5");
    const std::string checkpoint = directory / "checkpoint";
    picture({"--time", "0.1", "--checkpoint", checkpoint});
    expectRefusal(command("more.exr", {"--time", "0.2", "--resume", checkpoint}), 1, "scene's contents");
}

TEST_F(AnimationOptions, RefuseWhatIsNotThere)
{
    file.load();
    for (const std::string time : {"-1", "nan", "1e7", "soon"})
        expectRefusal(command("out.exr", {"--time", time}), 2, "--time");
    expectRefusal(command("out.exr", {"--animation", "walk"}), 1,
                  "The scene has no animation \"walk\": it has 0 \"slide\".");
    expectRefusal({"render", "cornell", "-o", directory / "out.exr", "--animation", "walk"}, 1,
                  "The scene has no animation \"walk\": it has none.");
    const Outcome still = run({"render", "cornell", "-o", directory / "out.exr", "--size", "8x8", "--time", "1"});
    EXPECT_EQ(still.exitCode, 0);
    EXPECT_EQ(still.err, "Warning: The scene has no animation: it is the same at every --time.\n");
}

TEST_F(AnimationOptions, BrokenOnesAreRefusedWhenAskedFor)
{
    breakTimes();
    const std::string why =
        "animations[1].samplers[0].input has the time 1 s at key 1 after 2 s, but times must increase: "
        "remove one of the keys.";
    picture({});
    EXPECT_NE(err.find("Warning: An animation cannot be played: " + why), std::string::npos) << err;
    picture({"--time", "1", "--animation", "slide"});
    for (const std::string animation : {"broken", "1", "all"})
        expectRefusal(command("out.exr", {"--animation", animation}), 1,
                      "Animation 1 \"broken\" cannot be played: " + why);
    picture({"--animation", "off"});
    EXPECT_EQ(err, "");
}

TEST_F(AnimationOptions, InfoTellsWhatMoves)
{
    breakTimes();
    const std::string json = directory / "info.json";
    const std::string told = run({"info", scene, "--time", "0.5", "--animation", "slide", "--json", json}).out;
    EXPECT_NE(told.find("Pose: time 0.5, animation slide\n"), std::string::npos) << told;
    EXPECT_NE(told.find("Animation 0 \"slide\": 2.000 s, 2 keys; moves translation of 1\n"), std::string::npos) << told;
    EXPECT_NE(told.find("Animation 1 \"broken\": 0.000 s, 0 keys; cannot be played: animations[1]"), std::string::npos);
    EXPECT_NE(told.find("Can move: 1 rigid parts, 1 triangles, 1 nodes;"), std::string::npos) << told;
    const nlohmann::json facts = readJson(json)["scene"], motion = facts["motion"];
    EXPECT_EQ(facts["pose"], nlohmann::json({{"time", "0.5"}, {"animation", "slide"}}));
    EXPECT_EQ(motion["animations"][0]["name"], "slide");
    EXPECT_EQ(motion["animations"][0]["seconds"], 2);
    EXPECT_EQ(motion["animations"][0]["moves"]["translation"], 1);
    EXPECT_FALSE(motion["animations"][0].contains("fault"));
    EXPECT_TRUE(motion["animations"][1].contains("fault"));
    EXPECT_EQ(motion["rigid_parts"], 1);
    EXPECT_GT(motion["host_bytes"], 0);
    EXPECT_NE(told.find("\nWhile it plays: "), std::string::npos) << told;
    EXPECT_GT(facts["playing"]["upload_bytes"], 0);
    EXPECT_GT(facts["playing"]["worlds_bytes"], facts["playing"]["upload_bytes"].get<uint64_t>());
}
