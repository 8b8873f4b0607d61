// compare REFERENCE IMAGE...: error figures and difference pictures; with limits, a gate.

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/base/json.h"
#include "engine/image/plane.h"
#include "ui/cli/number_range.h"
#include "ui/cli/output_file.h"
#include "ui/cli/usage_error.h"
#include "ui/commands/commands.h"
#include "ui/report/comparison_page.h"
#include "ui/report/page.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>
#include <optional>

namespace ui
{

namespace
{

using Json = nlohmann::ordered_json;

constexpr int EXIT_LIMIT_EXCEEDED = 1;

struct Gate {
    const char* figure;
    double limit, value;
    bool passed;
    std::string failure; // what is said when it has not
};

struct CompareCommand {
    std::string reference, html, json;
    std::vector<std::string> images;
    std::optional<double> maxFlip, minPsnr;

    std::vector<Gate> gatesOf(const image::Metrics& metrics) const;
    Json toJson(const ComparedPicture& picture) const;
    int run() const;
};

std::vector<Gate> CompareCommand::gatesOf(const image::Metrics& metrics) const
{
    std::vector<Gate> gates;
    if (maxFlip)
        gates.push_back({"flip", *maxFlip, metrics.flip, metrics.flip <= *maxFlip,
                         fmt::format("its FLIP of {:.5f} is above the limit of {}", metrics.flip, *maxFlip)});
    if (minPsnr)
        gates.push_back({"psnr", *minPsnr, metrics.psnr, metrics.psnr >= *minPsnr,
                         fmt::format("its PSNR of {:.3f} dB is below the limit of {} dB", metrics.psnr, *minPsnr)});
    return gates;
}

// JSON has no infinity: the PSNR of equal pictures and a ratio to 0 are null.
Json CompareCommand::toJson(const ComparedPicture& picture) const
{
    const image::Metrics& m = picture.metrics;
    Json gates = Json::array();
    for (const Gate& gate : gatesOf(m))
        gates.push_back(
            {{"figure", gate.figure}, {"limit", gate.limit}, {"value", gate.value}, {"passed", gate.passed}});
    return {{"image", picture.file},
            {"mse", m.mse},
            {"relmse", m.relmse},
            {"mape", m.mape},
            {"psnr", m.psnr},
            {"ssim", m.ssim},
            {"flip", m.flip},
            {"luma_mse", m.lumaMse},
            {"chroma_mse", m.chromaMse},
            {"mean_ratio", {m.meanRatio.r, m.meanRatio.g, m.meanRatio.b}},
            {"reference", reference},
            {"warnings", picture.loaded.warnings},
            {"gates", gates}};
}

// "a.exr:frame" is the layer "frame" of a.exr.
std::pair<std::string, std::string> fileAndLayer(const std::string& name)
{
    const size_t colon = name.rfind(':');
    if (colon == std::string::npos || files::extensionOf(name.substr(0, colon)) != ".exr") return {name, ""};
    return {name.substr(0, colon), name.substr(colon + 1)};
}

// With a warning about values below 0, which are rarely meant.
ComparedPicture load(const std::string& name)
{
    const auto [file, layer] = fileAndLayer(name);
    ComparedPicture picture{name, image::read(file, layer), {}};
    if (const size_t count = image::countBelowZero(picture.loaded.image))
        picture.loaded.warnings.push_back(fmt::format("Picture \"{}\" has {} values below 0: PSNR is of c/(1+|c|); "
                                                      "SSIM and FLIP compare what is below 0 as a picture of its own.",
                                                      name, count));
    for (const std::string& warning : picture.loaded.warnings) std::fprintf(stderr, "Warning: %s\n", warning.c_str());
    return picture;
}

void requireEqualSizes(const ComparedPicture& reference, const ComparedPicture& picture)
{
    const image::Image &r = reference.loaded.image, &x = picture.loaded.image;
    if (r.width != x.width || r.height != x.height)
        throw UsageError(
            "The reference \"{}\" has {}x{} pixels and the picture \"{}\" {}x{}, so they cannot be compared.",
            reference.file, r.width, r.height, picture.file, x.width, x.height);
}

void printTable(const std::vector<ComparedPicture>& pictures)
{
    std::vector<std::vector<std::string>> rows = {figureNames()};
    for (const ComparedPicture& picture : pictures) rows.push_back(figuresOf(picture));
    std::vector<size_t> widths(rows[0].size());
    for (const auto& row : rows)
        for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    for (const auto& row : rows) {
        std::string line = fmt::format("{:<{}}", row[0], widths[0]);
        for (size_t i = 1; i < row.size(); ++i) line += fmt::format("  {:>{}}", row[i], widths[i]);
        std::puts(line.c_str());
    }
}

int CompareCommand::run() const
{
    NamedFiles named;
    named.writes("--html", html);
    named.writes("--json", json);
    named.reads("REFERENCE", fileAndLayer(reference).first);
    for (const std::string& file : images) named.reads("IMAGE", fileAndLayer(file).first);
    if (!html.empty()) requireWritable(html, {".html"});
    if (!json.empty()) requireWritable(json);

    const ComparedPicture first = load(reference);
    std::vector<ComparedPicture> pictures;
    Json facts = Json::array();
    std::vector<std::string> failures;
    for (const std::string& file : images) {
        ComparedPicture picture = load(file);
        requireEqualSizes(first, picture);
        picture.metrics = whileDoing(fmt::format("comparing \"{}\" with the reference \"{}\"", file, reference),
                                     [&] { return image::measure(first.loaded.image, picture.loaded.image); });
        facts.push_back(toJson(picture));
        for (const Gate& gate : gatesOf(picture.metrics))
            if (!gate.passed) failures.push_back(fmt::format("Picture \"{}\": {}.", file, gate.failure));
        pictures.push_back(std::move(picture));
    }

    if (!json.empty()) writeText(json, jsonText(facts, 2) + "\n");
    if (!html.empty()) writeText(html, comparisonPage(first, pictures, failures, commandLine()));
    printTable(pictures);
    for (const std::string& failure : failures) std::fprintf(stderr, "trichrome: %s\n", failure.c_str());
    return failures.empty() ? 0 : EXIT_LIMIT_EXCEEDED;
}

} // namespace

Action setUpCompare(CLI::App& app)
{
    const auto command = std::make_shared<CompareCommand>();
    app.add_option("REFERENCE", command->reference,
                   "What the errors are measured against: EXR, HDR, PNG or JPEG. FILE.exr:NAME is a layer of an EXR.")
        ->required();
    app.add_option("IMAGE", command->images, "Pictures of the same size, named likewise.")->required();
    app.add_option("--html", command->html,
                   "Writes a page that needs nothing else: figures, maps of the errors, the worst places enlarged, a "
                   "viewer to flip through the pictures, and the settings in which they differ.")
        ->option_text("FILE.html");
    app.add_option("--json", command->json,
                   "Writes the figures for programs: a list, one object a picture; null where a figure is infinite.")
        ->option_text("FILE.json");
    app.add_option(
           "--max-flip", command->maxFlip,
           "The exit code is 1 when a picture's mean FLIP is above this. Of what a screen shows, 0 to 1: 0.01 "
           "is hardly visible noise. What is below 0 no screen shows: it is compared as a picture of its own, and the "
           "larger error counts. Default: no limit.")
        ->option_text("X")
        ->check(within(0.0, 1.0));
    app.add_option("--min-psnr", command->minPsnr,
                   "The exit code is 1 when a picture's PSNR is below this, in dB, peak 1, of c/(c+1), below 0 "
                   "of c/(1-c). Default: no limit.")
        ->option_text("X")
        ->check(within(0.0, 1000.0));
    return [command] { return command->run(); };
}

} // namespace ui
