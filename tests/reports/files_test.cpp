// Reported situations of files: pictures that are compared, and what stands behind the JSON of a .glb.

#include "tests/support/report_case.h"

#include <algorithm>

namespace
{

class FileReports : public ReportCase
{
  protected:
    bool says(const Outcome& outcome, const std::string& part) const
    {
        return outcome.err.find(part) != std::string::npos;
    }

    // Exit code 1 and one sentence.
    bool isRefused(const Outcome& outcome) const
    {
        return outcome.exitCode == 1 && outcome.err.starts_with("trichrome: Cannot load \"") &&
               std::ranges::count(outcome.err, '\n') == 1 && outcome.err.ends_with(".\n");
    }
};

} // namespace

TEST_F(FileReports, ComparedPictures)
{
    open("r26_compare");
    const auto first = [&] { return readJson(directory / "cmp.json").at(0); };
    const Outcome one = runCommand(0), both = runCommand(1);
    expect("NaN in one: fails, says where", {one.exitCode == 1, says(one, "pixel (3, 2) of the picture is nan")});
    expect("NaN in both: fails", both.exitCode == 1);
    const int equal = runCommand(2).exitCode;
    expect("equal: rc 0, PSNR infinite (null)", {equal, first()["psnr"], first()["mse"]});
    const int step = runCommand(3).exitCode;
    expect("1/255 in one sample is counted and fails a gate of 1000 dB", {step, first()["psnr"] < 100});
    const Outcome alpha = runCommand(4);
    EXPECT_EQ(alpha.exitCode, 0);
    expect("alpha only: stated", says(alpha, "r26_alpha.png\" has an alpha channel") && !says(alpha, "r26_a.png"));
    expect("size: exit code", runCommand(5).exitCode);
    const Outcome sizes = runCommand(6);
    expect("size: fails with a sentence that names both",
           {sizes.exitCode == 2, says(sizes, "r26_a.exr\" has 16x8"), says(sizes, "r26_small.exr\" 15x8")});
    expect("EXR against PNG of one size: figures", runCommand(7).exitCode);
}

TEST_F(FileReports, WhatStandsBehindTheJsonOfAGlb)
{
    open("c_glb_json_chunk");
    const std::vector<glm::vec3> plain = render(0).picture.pixels;
    const auto isRead = [&](const Outcome& outcome) {
        return outcome.exitCode == 0 && image::read(directory / "out.exr").image.pixels == plain;
    };
    const auto isSane = [&](size_t command) {
        const Outcome outcome = runCommand(command);
        return isRead(outcome) || isRefused(outcome);
    };
    expect("bom: read, or refused in one sentence", isSane(1));
    expect("nul: read, or refused in one sentence", isSane(2));
    expect("spaces: read, or refused in one sentence", isRead(runCommand(3)));
    const Outcome garbage = runCommand(4);
    expect("garbage behind the JSON", {isRefused(garbage), says(garbage, "c_garbage.glb"), says(garbage, "malformed")});
    expect("NUL and garbage behind the JSON: refused", isRefused(runCommand(5)));
    EXPECT_TRUE(isSane(6)); // bytes behind the last chunk
    expect("unknown chunk is skipped", isRead(runCommand(7)));
    expect(".gltf with BOM", isSane(8));
}
