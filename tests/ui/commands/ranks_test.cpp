// trichrome-mpi: `render` by several processes makes what one makes.
// Covers ui/ranks_mpi.cpp, ui/ranks_alone.cpp.

#include "tests/support/trichrome.h"

#include <cmath>

#include "engine/image/image.h"

namespace
{

class Ranks : public Trichrome
{
  protected:
    void SetUp() override
    {
        Trichrome::SetUp();
        if (const std::string missing = missingForRanks(); !missing.empty()) GTEST_SKIP() << missing;
    }

    std::vector<std::string> command(const std::string& output, const std::vector<std::string>& more,
                                     const std::string& scene = "cornell") const
    {
        std::vector<std::string> words = {"render", scene, "-o", directory / output};
        words.insert(words.end(), {"--size", "16x12", "--max-bounces", "2"});
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }

    // mpirun adds words of its own after a failure.
    static void expectOneSentence(const Outcome& outcome, int exitCode, const std::string& part)
    {
        SCOPED_TRACE(outcome.err);
        EXPECT_EQ(outcome.exitCode, exitCode);
        const size_t sentence = outcome.err.find("trichrome: ");
        ASSERT_NE(sentence, std::string::npos);
        EXPECT_EQ(outcome.err.find("trichrome: ", sentence + 1), std::string::npos);
        EXPECT_NE(outcome.err.find(part), std::string::npos) << "expected: " << part;
        EXPECT_EQ(outcome.err.find("MPI_ABORT"), std::string::npos) << "all know, and end by themselves";
    }

    static void expectWell(const Outcome& outcome)
    {
        EXPECT_EQ(outcome.exitCode, 0);
        EXPECT_EQ(outcome.err, "");
    }

    std::vector<glm::vec3> pixels(const std::string& name, const std::string& layer = "") const
    {
        return image::read(directory / name, layer).image.pixels;
    }

    // Of the first picture from the second, as part of the brightest value.
    float difference(const std::string& a, const std::string& b, const std::string& layer = "") const
    {
        const std::vector<glm::vec3> first = pixels(a, layer), second = pixels(b, layer);
        EXPECT_EQ(first.size(), second.size());
        float most = 0, brightest = 0;
        for (size_t i = 0; i < first.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                most = std::max(most, std::abs(first[i][c] - second[i][c]));
                brightest = std::max(brightest, first[i][c]);
            }
        EXPECT_GT(brightest, 0);
        return most / brightest;
    }
};

} // namespace

// Files are equal to the byte. A scene and a camera that move; chains of 2 frames, the last one shorter.
TEST_F(Ranks, ShareASequence)
{
    const auto same = [&](std::vector<std::string> more, int processes) {
        more.insert(more.end(), {"--sequence", "1:6", "--fps", "2", "--orbit", "1"});
        runWell(command("alone%d.exr", more, "flags"));
        expectWell(runRanks(processes, command("shared%d.exr", more, "flags")));
        for (const std::string frame : {"1.exr", "2.exr", "3.exr", "4.exr", "5.exr"})
            EXPECT_TRUE(readFile(directory / ("shared" + frame)) == readFile(directory / ("alone" + frame))) << frame;
        EXPECT_FALSE(std::filesystem::exists(directory / "shared0.exr"));
    };
    same({"--method", "restir-pt", "--shift", "replay", "--spatial", "0", "--warm-up", "1", "--restart", "2"}, 2);
    same({"--method", "pt", "--warm-up", "3"}, 4);
}

TEST_F(Ranks, ShareAStill)
{
    using Words = std::vector<std::string>;
    for (const Words& method :
         {Words{"--method", "pt"}, Words{"--method", "restir-pt", "--spatial", "0", "--restart", "2"}}) {
        const auto still = [&](const std::string& name) {
            Words words = {"--frames", "7", "--layers", "mean,frame", "--stats", directory / (name + ".json")};
            words.insert(words.end(), method.begin(), method.end());
            return command(name + ".exr", words);
        };
        runWell(still("alone"));
        expectWell(runRanks(3, still("three")));
        for (const std::string layer : {"", "mean"})
            EXPECT_LT(difference("three.exr", "alone.exr", layer), 1e-6) << method[1] << layer;
        EXPECT_EQ(pixels("three.exr", "frame"), pixels("alone.exr", "frame")) << method[1];
        const auto stats = readJson(directory / "three.json"), lone = readJson(directory / "alone.json");
        EXPECT_EQ(stats["frames"], 7);
        EXPECT_EQ(stats["processes"], 3);
        EXPECT_EQ(stats["partial"], false);
        for (const char* counts : {"shifts", "nonfinite", "settings"}) EXPECT_EQ(stats[counts], lone[counts]) << counts;
        EXPECT_EQ(stats["rays"]["shadow"], lone["rays"]["shadow"]); // each process traces what the camera sees
    }
    expectWell(runRanks(2, command("timed.exr", {"--seconds", "0.2"})));
    EXPECT_EQ(pixels("timed.exr").size(), 16u * 12);
}

TEST_F(Ranks, RefuseWhatTheyCannotShare)
{
    const auto refuses = [&](const std::vector<std::string>& words, const std::string& part) {
        expectOneSentence(runRanks(2, words), 2, part);
    };
    refuses(command("%d.exr", {"--sequence", "0:4", "--method", "rgb-restir"}), "--restart N");
    refuses(command("x.exr", {"--method", "restir-pt"}), "those of restir-pt do");
    refuses(command("x.exr", {"--average", "off"}), "cannot share one frame");
    refuses(command("x.exr", {"--checkpoint", directory / "x.ckpt"}), "are for one process");
    refuses({"info", "--scenes"}, "Only render and correlate");
    const Outcome unknown = runRanks(2, {"render", "cornell", "--wrong"});
    EXPECT_EQ(unknown.exitCode, 2);
    const size_t said = unknown.err.find("--wrong");
    EXPECT_EQ(unknown.err.find("--wrong", said + 1), std::string::npos) << unknown.err;
    EXPECT_TRUE(directory.entries().empty());
}

// Whichever it is, and whatever the others do meanwhile.
TEST_F(Ranks, EndTogetherWhereOneFails)
{
    const std::vector<std::string> good = command("x.exr", {"--frames", "100000000"}),
                                   bad = command("x.exr", {}, "nowhere");
    expectOneSentence(runRanks(2, bad), 1, "nowhere");
    expectOneSentence(runRanks(1, good, bad), 1, "nowhere");
    expectOneSentence(runRanks(1, bad, good), 1, "nowhere");
    EXPECT_TRUE(directory.entries().empty());

    // While all are at work: a directory that is lost.
    std::filesystem::create_directory(directory / "1.exr");
    const Outcome late = runRanks(2, command("%d.exr", {"--sequence", "0:100000"}));
    EXPECT_EQ(late.exitCode, 1);
    EXPECT_NE(late.err.find("1.exr"), std::string::npos) << late.err;
}
