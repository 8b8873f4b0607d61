// The render command, run as a person would: what it refuses, what it writes, and what it says about it.
// Covers ui/main.cpp, ui/ranks_alone.cpp, ui/cli/device_options.cpp, ui/cli/help.cpp, ui/cli/motion_options.cpp,
// ui/cli/output_file.cpp, ui/cli/run_report.cpp, ui/cli/scene_source.cpp.

#include "tests/support/trichrome.h"

#include "engine/image/image.h"
#include "tests/support/tiny_gltf.h"

#include <fcntl.h>
#include <map>
#include <sys/stat.h>
#include <unistd.h>

using namespace std::chrono_literals;

namespace
{

class Render : public Trichrome
{
  protected:
    // A small picture of the Cornell box, quick on any device.
    static std::vector<std::string> small(const std::string& output, const std::vector<std::string>& more = {})
    {
        std::vector<std::string> words = {"render", "cornell", "-o", output, "--size", "32x18"};
        words.insert(words.end(), {"--max-bounces", "2"});
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }

    static std::vector<glm::vec3> pixels(const std::string& file) { return image::read(file).image.pixels; }

    static std::map<std::string, std::string> metadata(const std::string& file)
    {
        const image::Metadata list = image::read(file).metadata;
        return {list.begin(), list.end()};
    }
};

} // namespace

TEST_F(Render, RefusesWrongUsageWithExitCode2)
{
    const std::string out = directory / "out.exr";
    expectRefusal({}, 2, "subcommand");
    expectRefusal({"paint"}, 2, "paint");
    expectRefusal({"render", "-o", out}, 2, "SCENE");
    expectRefusal({"render", "cornell"}, 2, "--output");
    expectRefusal(small(directory / "out.tga"), 2, "its extension must be one of: .exr, .png");
    expectRefusal(small(out, {"--sample", "3"}), 2, "--sample");
    expectRefusal(small(out, {"--max-confidence", "0"}), 2, "1 to 1048576");
    expectRefusal(small(out, {"--average", "maybe"}), 2, "off|on");
    expectRefusal(small(out, {"--set", "frames"}), 2, "name=value");
    expectRefusal(small(out, {"--set", "spam=1"}), 2, "There is no setting \"spam\"");
    expectRefusal(small(out, {"--set", "frames=-1"}), 2, "frames");
    expectRefusal(small(out, {"--orbit", "1", "--camera-path", "x.json"}), 2, "--camera-path");
    expectRefusal(small(out, {"--orbit", "1", "--average", "on"}), 2, "--average on cannot be combined with --orbit");
    expectRefusal(small(out, {"--layers", "mean,depth"}), 2, "depth");
    expectRefusal(small(directory / "out.png", {"--layers", "mean"}), 2, "--layers needs an EXR");
    expectRefusal(small(out, {"--orbit", "1", "--layers", "mean"}), 2, "--layers mean cannot be combined");
    EXPECT_TRUE(directory.entries().empty());
}

TEST_F(Render, RefusesAWrongWorldWithExitCode1)
{
    const std::string out = directory / "out.exr";
    expectRefusal({"render", "cornel", "-o", out}, 1, "cornel");
    expectRefusal({"render", "missing.glb", "-o", out}, 1, "missing.glb");
    expectRefusal(small("/nonexistent/out.exr"), 1, "there is no directory \"/nonexistent\"");
    expectRefusal(small(out, {"--stats", "/nonexistent/s.json"}), 1, "/nonexistent");
    expectRefusal(small(out, {"--device", "Voodoo"}), 1, "Voodoo");
    expectRefusal(small(out, {"--camera", "attic"}), 1, "attic");
    expectRefusal(small(out, {"--environment", "missing.exr"}), 1, "missing.exr");
    expectRefusal(small(out, {"--shaders", "/nonexistent"}), 1, "/nonexistent");
    expectRefusal(small(out, {"--camera-path", "missing.json"}), 1, "missing.json");
    expectRefusal(small(out, {"--preset", "missing.json"}), 1, "missing.json");
    const std::string preset = directory / "preset.json";
    for (const auto& [text, part] : std::map<std::string, std::string>{
             {"{", "malformed"}, {"[]", "object"}, {R"({"frames": "many"})", "frames"}, {R"({"spam": 1})", "spam"}}) {
        writeFile(preset, text);
        expectRefusal(small(out, {"--preset", preset}), 1, part);
    }
    EXPECT_EQ(directory.entries(), std::vector<std::string>{"preset.json"});
}

// Each pair of files that a command names, one of which it would write over the other.
TEST_F(Render, NoOutputIsWrittenOverAnotherFile)
{
    const std::string out = directory / "out.exr", same = directory / "sub/../out.exr", link = directory / "link.exr";
    std::filesystem::create_directory(directory / "sub");
    std::filesystem::create_symlink("out.exr", link); // to nothing yet
    const auto both = [&](const std::string& picture, const char* option, const std::string& other) {
        SCOPED_TRACE(option);
        expectRefusal(small(picture, {option, other}), 2, "--output and " + std::string(option) + " would both write");
    };
    both(out, "--stats", out);
    both(out, "--stats", same);
    both(link, "--checkpoint", out);
    expectRefusal(small(out, {"--stats", directory / "a", "--checkpoint", directory / "a"}), 2,
                  "--stats and --checkpoint would both write");
    EXPECT_EQ(directory.entries(), (std::vector<std::string>{"link.exr", "sub"}));

    TinyGltf file;
    const std::string scene = directory / "scene.gltf", texture = directory / "texture.png";
    const std::string preset = directory / "preset.json", sky = directory / "sky.exr", path = directory / "path.json";
    image::write(texture, {1, 1, {glm::vec3(1)}}, {});
    image::write(sky, {2, 1, {glm::vec3(1), glm::vec3(2)}}, {});
    writeFile(preset, "{}");
    writeFile(path, R"({"keyframes": [{"frame": 0, "position": [0, 0, 5], "target": [0, 0, 0]}]})");
    file.json["images"] = {{{"uri", "texture.png"}}};
    file.json["textures"] = {{{"source", 0}}};
    file.material() = {{"emissiveTexture", {{"index", 0}}}};
    writeFile(scene, file.text());
    std::filesystem::create_hard_link(sky, directory / "hard.exr");
    const auto over = [&](const std::string& output, const std::string& option, std::vector<std::string> words) {
        words.insert(words.begin(), {"render", scene, "--size", "8x8", "--frames", "1"});
        expectRefusal(words, 2, output + " would write over");
        expectRefusal(words, 2, "which " + option + " reads");
    };
    const std::vector<std::string> before = directory.entries();
    over("--stats", "SCENE", {"-o", out, "--stats", scene});
    over("--output", "SCENE", {"-o", texture});
    over("--output", "--environment", {"-o", sky, "--environment", sky});
    over("--output", "--environment", {"-o", directory / "hard.exr", "--environment", sky});
    over("--output", "--environment", {"-o", sky, "--set", "environment=" + sky});
    over("--stats", "--preset", {"-o", out, "--stats", preset, "--preset", preset});
    over("--checkpoint", "--camera-path", {"-o", out, "--checkpoint", path, "--camera-path", path});
    over("--output", "--resume", {"-o", sky, "--resume", sky});
    EXPECT_EQ(directory.entries(), before);
    EXPECT_EQ(image::read(sky).image.pixels[1], glm::vec3(2));

    expectRefusal({"info", scene, "--json", scene}, 2, "--json would write over");
    expectRefusal({"compare", sky, sky, "--json", sky}, 2, "--json would write over");
    expectRefusal({"compare", sky, sky, "--html", directory / "x.html", "--json", directory / "x.html"}, 2,
                  "--html and --json would both write");
    expectRefusal({"view", scene, "--report", scene}, 2, "--report would write over");
    image::write(directory / "reference.exr", {1, 1, {glm::vec3(1)}}, {});
    expectRefusal({"converge", scene, "-o", directory.path(), "--reference", directory / "reference.exr"}, 2,
                  "--output would write over");
    writeFile(directory / "settings.json", "{}");
    expectRefusal({"correlate", scene, "-o", directory.path(), "--preset", directory / "settings.json"}, 2,
                  "--output would write over");
}

TEST_F(Render, ALinkIsWrittenThroughAndADeviceWrittenTo)
{
    const std::string out = directory / "out.EXR", link = directory / "link.exr"; // names come in any case
    std::filesystem::create_symlink("out.EXR", link);
    runWell(small(link, {"--frames", "1"}));
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    EXPECT_EQ(pixels(out).size(), 32u * 18u);
    const std::string pipe = directory / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
    runWell(small(directory / "out.PNG", {"--frames", "1", "--stats", pipe}));
    char first = 0;
    EXPECT_EQ(read(reader, &first, 1), 1);
    EXPECT_EQ(first, '{');
    close(reader);
    EXPECT_TRUE(std::filesystem::is_fifo(pipe));
    EXPECT_EQ(pixels(directory / "out.PNG").size(), 32u * 18u);
}

TEST_F(Render, EqualSettingsAndSeedsGiveEqualPixelsAndOtherSeedsOthers)
{
    const std::string first = directory / "first.exr", second = directory / "second.exr",
                      other = directory / "other.exr";
    runWell(small(first, {"--frames", "4", "--seed", "7"}));
    runWell(small(second, {"--frames", "4", "--seed", "7"}));
    runWell(small(other, {"--frames", "4", "--seed", "8"}));
    EXPECT_EQ(pixels(first).size(), 32u * 18u);
    EXPECT_EQ(pixels(first), pixels(second));
    EXPECT_EQ(readFile(first), readFile(second)); // and equal files: no times inside
    EXPECT_NE(pixels(first), pixels(other));
    EXPECT_EQ(directory.entries().size(), 3u); // no temporary file is left
}

TEST_F(Render, AFileWhoseNameIsNoUtf8IsAsGoodAsAny)
{
    const std::string scene = directory / "h\xffll.gltf", stats = directory / "stats.json";
    TinyGltf file;
    writeFile(scene, file.text());
    for (const std::string& out : {directory / "a.exr", directory / "b.png"})
        EXPECT_EQ(run({"render", scene, "-o", out, "--size", "8x8", "--frames", "1", "--stats", stats, "--checkpoint",
                       directory / "x.ckpt"})
                      .exitCode,
                  0);
    EXPECT_TRUE(readJson(stats)["scene"].get<std::string>().ends_with("h\uFFFDll.gltf"));
}

TEST_F(Render, AverageOffWritesTheLastFrameOnly)
{
    const std::string mean = directory / "mean.exr", last = directory / "last.exr", one = directory / "one.exr";
    runWell(small(mean, {"--frames", "3"}));
    runWell(small(last, {"--frames", "3", "--average", "off"}));
    runWell(small(one, {"--frames", "1", "--average", "off"}));
    EXPECT_NE(pixels(mean), pixels(last));
    EXPECT_NE(pixels(one), pixels(last));
}

TEST_F(Render, LayersAreThePicturesThatOtherSettingsWrite)
{
    const std::string mean = directory / "mean.exr", last = directory / "last.exr", both = directory / "both.exr";
    const std::vector<std::string> three = {"--frames", "3", "--method", "restir-pt"};
    const auto with = [&](std::vector<std::string> words) {
        words.insert(words.end(), three.begin(), three.end());
        return words;
    };
    runWell(small(mean, three));
    runWell(small(last, with({"--average", "off"})));
    runWell(small(both, with({"--layers", "frame,mean"})));
    EXPECT_EQ(pixels(both), pixels(mean));
    EXPECT_EQ(image::read(both, "mean").image.pixels, pixels(mean));
    EXPECT_EQ(image::read(both, "frame").image.pixels, pixels(last));
    EXPECT_EQ(metadata(both), metadata(mean));

    const std::string json = directory / "c.json";
    runWell({"compare", last, both + ":frame", both, "--json", json});
    EXPECT_EQ(readJson(json)[0]["image"], both + ":frame");
    EXPECT_EQ(readJson(json)[0]["mse"], 0);
    EXPECT_GT(readJson(json)[1]["mse"], 0);
    expectRefusal({"compare", both, both + ":alpha"}, 1, "its layers are \"frame\", \"mean\".");
    expectRefusal({"compare", both + ":frame", both, "--json", both}, 2, "both.exr");
}

TEST_F(Render, PicturesCarryEverySettingAndWhereTheyComeFrom)
{
    for (const std::string& file : {directory / "a.exr", directory / "a.png"}) {
        const std::string stats = directory / "stats.json";
        runWell(small(file, {"--frames", "2", "--seed", "18446744073709551615", "--stats", stats}));
        const std::map<std::string, std::string> facts = metadata(file);
        const nlohmann::json done = readJson(stats);
        for (const auto& [name, value] : done["settings"].items()) EXPECT_TRUE(facts.contains(name)) << name;
        EXPECT_EQ(facts.at("seed"), "18446744073709551615");
        EXPECT_EQ(facts.at("size"), "32x18");
        EXPECT_EQ(facts.at("scene"), "cornell");
        EXPECT_EQ(facts.at("partial"), "no");
        EXPECT_EQ(facts.at("settings-hash"), done["settings_hash"]);
        EXPECT_EQ(facts.at("device"), done["device"]);
        EXPECT_EQ(facts.at("version"), done["version"]);
    }
}

TEST_F(Render, StatsHoldWhatTheContractNames)
{
    const std::string out = directory / "out.exr", stats = directory / "stats.json";
    runWell(small(out, {"--frames", "3", "--stats", stats}));
    const nlohmann::json done = readJson(stats);
    for (const char* key : {"scene",         "method",       "device",
                            "driver",        "width",        "height",
                            "frames",        "wall_seconds", "first_pixel_seconds",
                            "load_seconds",  "bvh_seconds",  "compile_seconds",
                            "stage_ms",      "rays",         "rays_per_second",
                            "nonfinite",     "mean_rgb",     "variant",
                            "bvh",           "memory_bytes", "settings",
                            "settings_hash", "version"})
        EXPECT_TRUE(done.contains(key)) << key;
    EXPECT_EQ(done["frames"], 3);
    EXPECT_EQ(done["width"], 32);
    EXPECT_EQ(done["rays"]["primary"], 32 * 18); // of the first frame: the camera rests
    for (const char* kind : {"bounce", "shadow", "replay", "reconnection"}) EXPECT_TRUE(done["rays"].contains(kind));
    for (const char* key : {"nodes", "bytes", "sah_cost"}) EXPECT_TRUE(done["bvh"].contains(key)) << key;
    EXPECT_GT(done["stage_ms"]["accumulate"], 0);
    EXPECT_GT(done["rays_per_second"], 0);
    EXPECT_GT(done["memory_bytes"], 32 * 18 * done["bytes_per_pixel"].get<double>() - 1);
    for (const auto& [stage, count] : done["nonfinite"].items()) EXPECT_EQ(count, 0) << stage;

    glm::dvec3 mean(0);
    for (const glm::vec3& pixel : pixels(out)) mean += glm::dvec3(pixel) / (32.0 * 18.0);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(done["mean_rgb"][size_t(c)].get<double>(), mean[c], 1e-9 * mean[c]);
}

TEST_F(Render, SettingsOfStatsAreAPreset)
{
    const std::string stats = directory / "stats.json", again = directory / "again.json", preset = directory / "p.json";
    const std::string first = directory / "a.exr", second = directory / "b.exr";
    runWell(small(first, {"--frames", "2", "--seed", "5", "--pixel-filter", "box", "--stats", stats}));
    writeFile(preset, readJson(stats)["settings"].dump());
    runWell({"render", "cornell", "-o", second, "--preset", preset, "--stats", again});
    EXPECT_EQ(readJson(stats)["settings_hash"], readJson(again)["settings_hash"]);
    EXPECT_EQ(pixels(first), pixels(second));
}

class RenderEnded : public Render, public testing::WithParamInterface<int>
{
};

INSTANTIATE_TEST_SUITE_P(Signals, RenderEnded, testing::Values(SIGINT, SIGTERM, SIGHUP),
                         [](const auto& ended) { return std::string(sigabbrev_np(ended.param)); });

TEST_P(RenderEnded, WritesWhatThereIsMarkedAsPartial)
{
    const std::string out = directory / "out.exr", stats = directory / "stats.json";
    writeFile(out, "before");
    // A signal before the first frame ends the program at once and leaves the file alone; then a slower machine gets
    // more time.
    for (auto delay = 1000ms; delay < 60s; delay *= 2) {
        const Outcome outcome = run(small(out, {"--frames", "1000000", "--stats", stats}), delay, GetParam());
        EXPECT_EQ(outcome.exitCode, 128 + GetParam());
        if (readFile(out) == "before") continue;
        EXPECT_NE(outcome.err.find("partial"), std::string::npos) << outcome.err;
        break;
    }
    EXPECT_EQ(metadata(out).at("partial"), "yes");
    EXPECT_EQ(pixels(out).size(), 32u * 18u);
    const nlohmann::json done = readJson(stats);
    EXPECT_EQ(done["partial"], true);
    EXPECT_EQ(metadata(out).at("frames-done"), std::to_string(done["frames"].get<uint64_t>()));
    EXPECT_GT(done["frames"], 0);
    EXPECT_LT(done["frames"], 1000000);
    EXPECT_EQ(directory.entries(), (std::vector<std::string>{"out.exr", "stats.json"}));
}

TEST_F(Render, SecondsStopByTime)
{
    const std::string stats = directory / "stats.json";
    runWell(small(directory / "out.exr", {"--frames", "1", "--seconds", "0.5", "--stats", stats}));
    const nlohmann::json done = readJson(stats);
    EXPECT_GE(done["wall_seconds"], 0.5);
    EXPECT_LT(done["wall_seconds"], 10);
    EXPECT_GT(done["frames"], 1);
    EXPECT_EQ(done["partial"], false);
}

TEST_F(Render, AMovingCameraWritesItsLastFrameFromWhereItIsThen)
{
    const std::string still = directory / "still.exr", orbit = directory / "orbit.exr", path = directory / "path.exr";
    const std::string stats = directory / "stats.json", keys = directory / "keys.json";
    runWell(small(still, {"--frames", "1"}));
    runWell(small(orbit, {"--frames", "1", "--orbit", "10"})); // has not moved yet
    EXPECT_EQ(pixels(still), pixels(orbit));
    runWell(small(orbit, {"--frames", "3", "--orbit", "10", "--stats", stats}));
    EXPECT_EQ(readJson(stats)["settings"]["average"], false);
    EXPECT_EQ(metadata(orbit).at("orbit"), "10");

    // The orbit's third frame, as a keyframe: from the front of the box, 20 degrees around its middle.
    const double s = std::sin(glm::radians(20.0)), c = std::cos(glm::radians(20.0)), distance = -0.79 - 0.28;
    const nlohmann::json key = {{"frame", 0},
                                {"position", {0.2764 + s * distance, 0.2744, 0.28 + c * distance}},
                                {"target", {0.2764, 0.2744, 0.28}}};
    writeFile(keys, nlohmann::json{{"keyframes", {key}}}.dump());
    runWell(small(path, {"--frames", "3", "--camera-path", keys}));
    const std::vector<glm::vec3> a = pixels(orbit), b = pixels(path);
    size_t different = 0;
    for (size_t i = 0; i < a.size(); ++i) different += glm::distance(a[i], b[i]) > 1e-3f * (1 + glm::length(a[i]));
    EXPECT_LT(different, a.size() / 50); // rounding may move an edge
    EXPECT_NE(pixels(still), b);
}

// docs/LIGHT_TRANSPORT.md, Environment: which way a sky's columns and rows lie, and that it is not mirrored.
TEST_F(Render, ASkyLiesAsDocumented)
{
    const std::string scene = directory / "scene.gltf", sky = directory / "sky.exr", out = directory / "out.exr",
                      path = directory / "path.json";
    TinyGltf file; // a triangle at the origin, behind the camera or beside what it looks at
    writeFile(scene, file.text());
    image::Image picture{8, 4, {}};
    for (uint32_t i = 0; i < 32; ++i) picture.pixels.emplace_back(1 + i % 8, 1 + i / 8, 1);
    image::write(sky, picture, {});
    const auto look = [&](const glm::dvec3& towards, const glm::dvec3& up) { // 2x2 pixels about the direction
        const glm::dvec3 from(50, 60, 70), to = from + towards;
        const nlohmann::json key = {{"frame", 0},
                                    {"position", {from.x, from.y, from.z}},
                                    {"target", {to.x, to.y, to.z}},
                                    {"up", {up.x, up.y, up.z}},
                                    {"yfov", 1}};
        writeFile(path, nlohmann::json{{"keyframes", {key}}}.dump());
        const Outcome outcome = run({"render", scene, "-o", out, "--size", "2x2", "--frames", "1", "--environment", sky,
                                     "--camera-path", path});
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err; // warns: the file has no camera
        return pixels(out);
    };
    const std::pair<glm::dvec3, float> sides[] = {{{1, 0, 0}, 3}, {{0, 0, 1}, 5}, {{-1, 0, 0}, 7}, {{0, 0, -1}, 1}};
    for (const auto& [towards, left] : sides) {
        const float right = left == 7 ? 0 : left + 1;
        EXPECT_EQ(look(towards, {0, 1, 0}),
                  (std::vector<glm::vec3>{{1 + left, 2, 1}, {1 + right, 2, 1}, {1 + left, 3, 1}, {1 + right, 3, 1}}))
            << towards.x << " " << towards.z;
    }
    for (const glm::vec3& pixel : look({0, 1, 0}, {1, 0, 0})) EXPECT_EQ(pixel.g, 1);
    for (const glm::vec3& pixel : look({0, -1, 0}, {1, 0, 0})) EXPECT_EQ(pixel.g, 4);
}

TEST_F(Render, NoFileIsWrittenWhenTheWorkFails)
{
    const std::string out = directory / "out.exr";
    writeFile(out, "before");
    expectRefusal(small(out, {"--camera", "attic"}), 1, "attic");
    EXPECT_EQ(readFile(out), "before");
}
