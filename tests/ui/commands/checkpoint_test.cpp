// render --checkpoint and --resume as a person uses them: broken off, killed, gone on with, and refused.
// Covers ui/cli/checkpoint_options.cpp, ui/cli/interrupt.cpp.

#include "tests/support/trichrome.h"

#include "engine/image/image.h"

#include <map>

using namespace std::chrono_literals;

namespace
{

class CheckpointCommand : public Trichrome
{
  protected:
    std::vector<std::string> render(const std::string& output, const std::vector<std::string>& more) const
    {
        std::vector<std::string> words = {"render", "cornell", "-o", directory / output, "--size", "32x18"};
        words.insert(words.end(), {"--max-bounces", "2"});
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }

    std::string framesDone(const std::string& picture) const
    {
        for (const auto& [name, value] : image::read(directory / picture).metadata)
            if (name == "frames-done") return value;
        return "";
    }

    const std::string checkpoint = directory / "x.ckpt";
};

} // namespace

TEST_F(CheckpointCommand, AFinishedRenderGetsMoreFramesAsIfItHadNeverEnded)
{
    struct Case {
        std::string method;
        std::vector<std::string> motion;
    };
    for (const Case& c : {Case{"pt", {}}, Case{"rgb-restir", {"--orbit", "3"}}}) {
        const auto with = [&](std::vector<std::string> words) {
            words.insert(words.end(), {"--method", c.method});
            words.insert(words.end(), c.motion.begin(), c.motion.end());
            return words;
        };
        runWell(render("whole.exr", with({"--frames", "6"})));
        runWell(render("first.exr", with({"--frames", "4", "--checkpoint", checkpoint})));
        runWell(render("second.exr", with({"--frames", "6", "--resume", checkpoint})));
        EXPECT_EQ(readFile(directory / "whole.exr"), readFile(directory / "second.exr")) << c.method;
        runWell(render("again.exr", with({"--frames", "4", "--resume", checkpoint}))); // nothing left to render
        EXPECT_EQ(readFile(directory / "first.exr"), readFile(directory / "again.exr")) << c.method;
    }
}

TEST_F(CheckpointCommand, SigtermLosesNothing)
{
    for (auto delay = 1000ms; delay < 60s; delay *= 2) { // the first frame may come late
        const auto words = render("partial.exr", {"--frames", "1000000", "--checkpoint", checkpoint});
        EXPECT_EQ(run(words, delay, SIGTERM).exitCode, 143); // as Slurm and containers ask for the end
        if (std::filesystem::exists(checkpoint)) break;
    }
    const std::string frames = std::to_string(std::stoull(framesDone("partial.exr")) + 2);
    runWell(render("whole.exr", {"--frames", frames}));
    runWell(render("resumed.exr", {"--frames", frames, "--resume", checkpoint}));
    EXPECT_EQ(readFile(directory / "whole.exr"), readFile(directory / "resumed.exr"));
}

TEST_F(CheckpointCommand, KilledAgainAndAgainItStillArrivesAtTheSamePicture)
{
    const std::vector<std::string> settings = {"--frames", "60", "--method", "restir-pt"};
    runWell(render("whole.exr", settings));
    std::vector<std::string> words = settings;
    words.insert(words.end(), {"--checkpoint", checkpoint, "--checkpoint-interval", "0"});
    int killed = 0;
    for (auto delay = 400ms; delay < 60s; delay += delay / 3) {
        std::vector<std::string> all = words;
        if (std::filesystem::exists(checkpoint)) all.insert(all.end(), {"--resume", checkpoint});
        const Outcome outcome = run(render("killed.exr", all), delay, SIGKILL);
        if (outcome.exitCode == 0) break;
        ASSERT_EQ(outcome.exitCode, 128 + SIGKILL) << outcome.err;
        ++killed;
    }
    EXPECT_GT(killed, 0);
    EXPECT_EQ(readFile(directory / "whole.exr"), readFile(directory / "killed.exr"));
    EXPECT_EQ(directory.entries(), (std::vector<std::string>{"killed.exr", "whole.exr", "x.ckpt"})); // nothing half
}

TEST_F(CheckpointCommand, RefusesWhatIsNotItsOwn)
{
    runWell(render("a.exr", {"--frames", "2", "--orbit", "3", "--checkpoint", checkpoint}));
    const auto with = [&](std::vector<std::string> words) {
        words.insert(words.end(), {"--resume", checkpoint});
        return render("b.exr", words);
    };
    expectRefusal(with({"--orbit", "3", "--seed", "1"}), 1, R"(its seed is "0", not "1")");
    expectRefusal(with({"--orbit", "3", "--method", "restir-pt"}), 1, R"(its method is "pt", not "restir-pt")");
    expectRefusal(with({"--orbit", "3", "--frames", "1"}), 1, "it has 2 frames already");
    expectRefusal(with({"--orbit", "4"}), 1, R"(its orbit is "3", not "4")");
    expectRefusal(with({}), 1, R"(it was rendered with orbit "3")");
    std::vector<std::string> hall = with({"--orbit", "3"});
    hall[1] = "hall";
    expectRefusal(hall, 1, "its scene's contents is");
    expectRefusal(render("b.exr", {"--resume", "/nonexistent"}), 1, "no such file");
    expectRefusal(render("b.exr", {"--checkpoint", "/nonexistent/x"}), 1, "/nonexistent");
    expectRefusal(render("b.exr", {"--checkpoint-interval", "-1"}), 2, "--checkpoint-interval");

    std::string bytes = readFile(checkpoint);
    bytes[bytes.size() / 2] ^= 1;
    writeFile(checkpoint, bytes);
    expectRefusal(with({"--orbit", "3"}), 1, "is damaged");
    writeFile(checkpoint, bytes.substr(0, bytes.size() - 1));
    expectRefusal(with({"--orbit", "3"}), 1, "cut short");
    EXPECT_EQ(directory.entries(), (std::vector<std::string>{"a.exr", "x.ckpt"}));
}

TEST_F(CheckpointCommand, TheContentsOfACameraPathCountNotItsName)
{
    const auto key = [](int frame, double x) {
        return nlohmann::json{{"frame", frame}, {"position", {x, 0.27, -0.8}}, {"target", {0.27, 0.27, 0.28}}};
    };
    writeFile(directory / "a.json", nlohmann::json{{"keyframes", {key(0, 0.1), key(8, 0.4)}}}.dump());
    writeFile(directory / "b.json", readFile(directory / "a.json"));
    writeFile(directory / "c.json", nlohmann::json{{"keyframes", {key(0, 0.1), key(8, 0.5)}}}.dump());
    const auto with = [&](const std::string& path, const char* frames, const char* option) {
        return render("a.exr", {"--camera-path", directory / path, "--frames", frames, option, checkpoint});
    };
    runWell(with("a.json", "2", "--checkpoint"));
    runWell(with("b.json", "3", "--resume"));
    expectRefusal(with("c.json", "3", "--resume"), 1, "camera path's contents");
}
