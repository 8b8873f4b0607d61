// The converge command, run as a person would: tiny races, what they leave behind, stopping and going on.

#include "tests/support/trichrome.h"

#include "engine/image/image.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>

using namespace std::chrono_literals;

namespace
{

class Converge : public Trichrome
{
  protected:
    void SetUp() override
    {
        Trichrome::SetUp();
        setenv("XDG_CACHE_HOME", (directory / "cache").c_str(), 1); // of this process, and so of the program
    }

    std::vector<std::string> tiny(const std::string& out, const std::vector<std::string>& more = {}) const
    {
        std::vector<std::string> words = {"converge", "cornell",       "-o", directory / out,      "--size",
                                          "16x12",    "--max-bounces", "2",  "--reference-frames", "64"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    std::string file(const std::string& name) const { return readFile(directory / name); }
    std::map<std::string, std::string> metadata(const std::string& picture) const
    {
        const image::Metadata list = image::read(directory / picture).metadata;
        return {list.begin(), list.end()};
    }
    std::vector<std::vector<std::string>> rows(const std::string& name) const
    {
        std::vector<std::vector<std::string>> table;
        std::istringstream text(file(name));
        for (std::string line; std::getline(text, line);) {
            table.emplace_back();
            std::istringstream cells(line);
            for (std::string cell; std::getline(cells, cell, ',');) table.back().push_back(cell);
        }
        return table;
    }
};

} // namespace

TEST_F(Converge, LeavesATableAPageAndPictures)
{
    const Outcome outcome =
        runWell(tiny("out", {"--runs", "2", "--frames", "4", "--methods", "restir-pt:spatial=0,rgb-restir:replay"}));
    EXPECT_NE(outcome.out.find("equal time"), std::string::npos) << outcome.out;
    const auto table = rows("out/converge.csv");
    const std::vector<std::string> contract = {"scene",  "method",  "shift",     "max_confidence", "repeat",
                                               "frames", "seconds", "mse",       "relmse",         "psnr",
                                               "ssim",   "flip",    "chroma_mse"};
    ASSERT_GE(table.at(0).size(), contract.size());
    EXPECT_TRUE(std::ranges::equal(contract, std::span(table[0]).first(contract.size())));
    // pt, which was not asked for, and two methods; two repeats; 1, 2, 3 and 4 frames; means and single frames.
    EXPECT_EQ(table.size(), 1 + 3 * 2 * 4 * 2u);
    EXPECT_EQ(std::ranges::count_if(table, [](const auto& row) { return row[1] == "pt"; }), 16);
    EXPECT_EQ(std::ranges::count_if(table, [](const auto& row) { return row[2] == "replay"; }), 16);
    for (size_t i = 1; i < table.size(); ++i) {
        EXPECT_EQ(table[i].size(), table[0].size());
        EXPECT_GT(std::stod(table[i][6]), 0);
        EXPECT_GT(std::stod(table[i][9]), 0);
    }
    const std::string page = file("out/index.html");
    for (const char* part : {"class=\"verdict\"", "restir-pt:spatial=0", "rgb-restir:replay", "data:image/png;base64",
                             "Means of all frames", "--runs 2", "All settings", "</html>"})
        EXPECT_NE(page.find(part), std::string::npos) << part;
    EXPECT_EQ(page.find("class=\"partial\""), std::string::npos);
    EXPECT_EQ(image::read(directory / "out/reference.exr").image.pixels.size(), 16 * 12u);
    EXPECT_EQ(image::read(directory / "out/pictures/00-pt.exr").image.pixels.size(), 16 * 12u);
}

TEST_F(Converge, AMovingCameraIsMeasuredFrameByFrame)
{
    runWell(tiny("out", {"--runs", "2", "--frames", "3", "--orbit", "5", "--methods", "pt,restir-pt"}));
    EXPECT_EQ(metadata("out/reference-3.exr").at("orbit"), "5");
    const auto table = rows("out/converge.csv");
    EXPECT_EQ(table.size(), 1 + 2 * 2 * 3u);
    for (const char* name : {"1", "2", "3"}) EXPECT_FALSE(file(std::string("out/reference-") + name + ".exr").empty());
    EXPECT_NE(file("out/index.html").find("moving camera"), std::string::npos);
}

TEST_F(Converge, ResumeSkipsWhatIsDoneAndRefusesOtherSettings)
{
    const std::vector<std::string> common = {"--frames", "2", "--methods", "pt,restir-pt"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), common.begin(), common.end());
        return tiny("out", more);
    };
    runWell(with({"--runs", "2"}));
    const std::string first = file("out/repeats/0000.json");
    runWell(with({"--runs", "3", "--resume"}));      // more repeats of the same
    EXPECT_EQ(file("out/repeats/0000.json"), first); // with its times
    const auto table = rows("out/converge.csv");
    EXPECT_EQ(table.size(), 1 + 3 * 2 * 2 * 2u);
    expectRefusal(with({"--runs", "3", "--resume", "--seed", "5"}), 1, "Cannot resume");
    expectRefusal(with({"--runs", "2"}), 1, "holds a measurement already");
    EXPECT_EQ(file("out/repeats/0000.json"), first);
}

TEST_F(Converge, CtrlCLeavesAPartialReportThatResumeCompletes)
{
    const std::vector<std::string> words = tiny("out", {"--runs", "3", "--seconds", "2", "--methods", "pt"});
    bool partial = false;
    // Before the first frame Ctrl-C ends the program at once; then a slower machine gets more time.
    for (auto delay = 1500ms; delay < 60s && !partial; delay *= 2) {
        const Outcome outcome = run(words, delay);
        if (outcome.exitCode == 0) break;
        EXPECT_EQ(outcome.exitCode, 130);
        partial = std::filesystem::exists(directory / "out/index.html");
        if (partial) {
            EXPECT_NE(outcome.err.find("partial"), std::string::npos) << outcome.err;
        }
    }
    ASSERT_TRUE(partial);
    EXPECT_NE(file("out/index.html").find("class=\"partial\""), std::string::npos);
    EXPECT_NE(file("out/index.html").find("</html>"), std::string::npos);
    EXPECT_EQ(rows("out/converge.csv").at(0).at(0), "scene");
    std::vector<std::string> again = words;
    again.push_back("--resume");
    runWell(again);
    EXPECT_EQ(file("out/index.html").find("class=\"partial\""), std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(directory / "out/repeats/0002.json"));
}

TEST_F(Converge, MeasuresAgainstAFile)
{
    const std::string reference = directory / "reference.exr";
    runWell({"render", "cornell", "-o", reference, "--size", "16x12", "--max-bounces", "2", "--frames", "64"});
    runWell(tiny("out",
                 {"--runs", "2", "--frames", "2", "--methods", "pt", "--reference", reference, "--animation", "off"}));
    EXPECT_NE(file("out/index.html").find("nothing is subtracted"), std::string::npos);
    EXPECT_EQ(image::read(directory / "out/reference.exr").image.pixels, image::read(reference).image.pixels);
    EXPECT_EQ(metadata("out/reference.exr").at("animation"), "off");
    const std::string small = directory / "small.exr";
    runWell({"render", "cornell", "-o", small, "--size", "8x8", "--max-bounces", "2", "--frames", "1"});
    expectRefusal(tiny("other", {"--reference", small}), 1, "has 8x8 pixels, but --size is 16x12");
    expectRefusal(tiny("other", {"--reference", "missing.exr"}), 1, "missing.exr");
    expectRefusal(tiny("out", {"--reference", reference, "--orbit", "1"}), 2, "--reference FILE cannot be combined");
}

TEST_F(Converge, RefusesWrongUsage)
{
    expectRefusal({"converge", "cornell"}, 2, "--output");
    expectRefusal(tiny("out", {"--runs", "0"}), 2, "--runs");
    expectRefusal(tiny("out", {"--methods", "pt,metropolis"}), 2, "metropolis");
    expectRefusal(tiny("out", {"--methods", "pt,pt"}), 2, "twice");
    expectRefusal(tiny("out", {"--methods", "pt:size=4x4"}), 2, "must share");
    expectRefusal(tiny("out", {"--orbit", "1", "--seconds", "5"}), 2, "--seconds cannot be combined");
    expectRefusal(tiny("out", {"--reference-error", "7"}), 2, "--reference-error");
    EXPECT_TRUE(directory.entries().empty());
    writeFile(directory / "taken", "");
    expectRefusal(tiny("taken"), 1, "taken");
    expectRefusal({"converge", "cornel", "-o", directory / "new"}, 1, "cornel");
}
