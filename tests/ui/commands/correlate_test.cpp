// The correlate command, run as a person would.

#include "tests/support/trichrome.h"

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "engine/image/image.h"

using namespace std::chrono_literals;

namespace
{

using Row = std::map<std::string, std::string>;

class Correlate : public Trichrome
{
  protected:
    static std::vector<std::string> small(const std::string& output, const std::vector<std::string>& more = {},
                                          const char* runs = "8")
    {
        std::vector<std::string> words = {"correlate",     "cornell", "-o",     output, "--size",           "8x6",
                                          "--max-bounces", "2",       "--runs", runs,   "--max-confidence", "16"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }

    static std::vector<Row> rows(const std::string& directory)
    {
        std::istringstream lines(readFile(directory + "/correlate.csv"));
        std::vector<std::string> header;
        std::vector<Row> result;
        for (std::string line; std::getline(lines, line);) {
            std::vector<std::string> cells;
            std::istringstream parts(line);
            for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
            if (header.empty()) {
                header = cells;
                continue;
            }
            EXPECT_EQ(cells.size(), header.size()) << line;
            Row row;
            for (size_t i = 0; i < header.size(); ++i) row[header[i]] = cells.at(i);
            result.push_back(row);
        }
        return result;
    }
};

} // namespace

TEST_F(Correlate, LeavesAPageThatStandsAloneAndFiguresThatFollowTheLaw)
{
    const std::string out = directory / "out";
    const Outcome outcome = run(small(out, {"--frames", "8", "--batch", "4"}));
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("progressive accumulation"), std::string::npos) << outcome.out;
    int measured = 0;
    const std::vector<Row> table = rows(out);
    ASSERT_EQ(table.size(), 8u); // two methods, M = 2, 4, 8, 16
    for (Row row : table) {
        EXPECT_EQ(row["scene"], "cornell");
        EXPECT_EQ(row["shift"], "replay");
        EXPECT_GT(std::stod(row["predicted"]), 0);
        EXPECT_GT(std::stod(row["sigma2"]), 0);
        const bool beyond = row["max_confidence"] == "16";
        EXPECT_EQ(row["runs"], beyond ? "0" : "8");
        EXPECT_EQ(row["pixels"], beyond ? "0" : "48");
        if (beyond) continue;
        EXPECT_LT(std::stod(row["ci_low"]), std::stod(row["autocovariance"]));
        EXPECT_LT(std::stod(row["autocovariance"]), std::stod(row["ci_high"]));
        EXPECT_LT(std::abs(std::stod(row["z"])), 5) << row["method"] << " " << row["max_confidence"];
        ++measured;
    }
    EXPECT_EQ(measured, 6);
    const std::string page = readFile(out + "/index.html");
    for (const char* part : {"<!DOCTYPE html>", "progressive accumulation", "data:image/png;base64,", "σ²"})
        EXPECT_NE(page.find(part), std::string::npos) << part;
    EXPECT_EQ(page.find("src=\"http"), std::string::npos);
    EXPECT_EQ(page.find("Partial"), std::string::npos);
    const image::Image floor = image::read(out + "/color-noise-floor-restir-pt.exr").image;
    EXPECT_EQ(floor.width, 8u);
    EXPECT_EQ(floor.height, 6u);

    // A second start is refused; --resume finds everything done, changes nothing, and takes no other settings.
    expectRefusal(small(out, {"--frames", "8", "--batch", "4"}), 1, "--resume");
    const std::string before = readFile(out + "/correlate.csv");
    EXPECT_EQ(run(small(out, {"--frames", "8", "--batch", "4", "--resume"})).exitCode, 0);
    EXPECT_EQ(readFile(out + "/correlate.csv"), before);
    expectRefusal(small(out, {"--frames", "8", "--batch", "4", "--resume", "--seed", "7"}), 1,
                  "seed = \"0\", not \"7\"");

    // A batch that a kill left out is measured again, to the same bits.
    std::filesystem::remove(out + "/batches/00001-4-runs-rgb-restir.cbor");
    EXPECT_EQ(run(small(out, {"--frames", "8", "--batch", "4", "--resume"})).exitCode, 0);
    EXPECT_EQ(readFile(out + "/correlate.csv"), before);
}

TEST_F(Correlate, MoreRunsGoOnWithTheBatchesThatAreThere)
{
    const std::string grown = directory / "grown", whole = directory / "whole";
    const auto with = [](const std::string& out, const char* runs) {
        return small(out, {"--frames", "4", "--batch", "4", "--resume"}, runs);
    };
    EXPECT_EQ(run(with(grown, "6")).exitCode, 0); // 3 and 3: two are no batch
    EXPECT_EQ(run(with(grown, "8")).exitCode, 0);
    const std::filesystem::path batch = grown + "/batches/00001-4-runs-rgb-restir.cbor";
    const auto made = std::filesystem::last_write_time(batch);
    EXPECT_EQ(run(with(grown, "11")).exitCode, 0);
    EXPECT_EQ(run(with(whole, "11")).exitCode, 0);
    EXPECT_EQ(readFile(grown + "/correlate.csv"), readFile(whole + "/correlate.csv"));
    EXPECT_EQ(rows(grown).front()["runs"], "11");
    EXPECT_EQ(run(with(grown, "9")).exitCode, 0); // 3, 3 and 3: one is no batch
    EXPECT_EQ(rows(grown).front()["runs"], "9");
    EXPECT_EQ(std::filesystem::last_write_time(batch), made);
}

TEST_F(Correlate, CtrlCLeavesAPartialReportThatCanBeResumed)
{
    const std::string out = directory / "out";
    std::vector<std::string> words = small(out, {"--methods", "restir-pt", "--batch", "4"});
    words[11] = "1048576";
    const Outcome outcome = run(words, 8s);
    EXPECT_EQ(outcome.exitCode, 130) << outcome.err;
    EXPECT_NE(outcome.err.find("partial"), std::string::npos) << outcome.err;
    EXPECT_NE(readFile(out + "/index.html").find("Partial"), std::string::npos);
    EXPECT_EQ(readFile(out + "/correlate.csv").find("scene,method,shift"), 0u);
}

TEST_F(Correlate, FollowsSurfacesUnderAMovingCamera)
{
    const std::string out = directory / "out";
    const Outcome outcome =
        run(small(out, {"--orbit", "2", "--methods", "rgb-restir:hybrid", "--frames", "4", "--batch", "8"}));
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("The camera moves"), std::string::npos) << outcome.out;
    const std::vector<Row> table = rows(out);
    ASSERT_EQ(table.size(), 2u);
    for (Row row : table) {
        EXPECT_EQ(row["predicted"], "nan");
        EXPECT_LE(std::stoi(row["pixels"]), 48);
        EXPECT_GT(std::stoi(row["pixels"]), 20);
    }
}

TEST_F(Correlate, RefusesWhatItCannotMeasure)
{
    const std::string out = directory / "out";
    expectRefusal(small(out, {"--method", "pt"}), 2, "--methods");
    expectRefusal(small(out, {"--methods", "pt"}), 2, "no history");
    expectRefusal(small(out, {"--methods", "restir-pt,warp"}), 2, "warp");
    expectRefusal(small(out, {"--pixel-filter", "box"}), 2, "center");
    expectRefusal(small(out, {"--frames", "1"}), 2, "at least 2");
    expectRefusal({"correlate", "attic", "-o", out}, 1, "attic");
    expectRefusal({"correlate", "cornell"}, 2, "--output");
    writeFile(directory / "file", "x");
    expectRefusal(small(directory / "file"), 1, "file");
    EXPECT_EQ(directory.entries(), std::vector<std::string>{"file"}); // nothing was begun
}

TEST_F(Correlate, IsTheSameOnTwoRanksToTheBit)
{
    if (const std::string missing = missingForRanks(); !missing.empty()) GTEST_SKIP() << missing;
    const std::string alone = directory / "alone", two = directory / "two";
    ASSERT_EQ(run(small(alone, {"--batch", "4"})).exitCode, 0);
    const Outcome outcome = runRanks(2, small(two, {"--batch", "4"}));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(readFile(two + "/correlate.csv"), readFile(alone + "/correlate.csv"));
    EXPECT_NE(readFile(two + "/index.html").find("mpirun -n 2"), std::string::npos);
}
