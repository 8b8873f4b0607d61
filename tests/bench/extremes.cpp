// Every method in stiff and extreme cases: everything finite, the mean right. Writes extremes.csv, .html and .md; the
// exit code is 1 when a value was not finite or a mean is off.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "engine/base/clock.h"
#include "engine/base/csv.h"
#include "engine/base/error.h"
#include "engine/base/files.h"
#include "passes/camera_path.h"
#include "passes/renderer.h"
#include "tests/bench/extreme_cases.h"
#include "ui/report/page.h"

namespace
{

using bench::ExtremeCase;
using statistics::Estimate, statistics::Moments;

constexpr double LIMIT = 4;        // of |z|
constexpr uint32_t PT_FRAMES = 15; // of the path tracer for each run of ReSTIR
constexpr double ROUNDING = 5e-5;  // relative: the device's vertex colors have half precision

struct Figures {
    uint64_t nonFinite = 0;
    double z = 0;                // the worst of all tiles, and of the picture as a whole
    double relativeVariance = 0; // of a pixel in one run, mean over the picture, over the square of its mean
    double largest = 0;          // pixel of any run, over the picture's mean
    double meanOverTruth = 1;    // of the picture
};

struct Row {
    const ExtremeCase* extreme;
    std::map<std::string, Figures> methods;
};

// The normal deviate that is as improbable as this difference.
double zOf(const Estimate& a, const Estimate& b)
{
    const statistics::Difference d = statistics::compare(a, b, ROUNDING);
    if (d.difference == 0) return 0;
    const double t = std::abs(d.difference) / d.standardError;
    return d.p > 1e-14 ? std::min(t, statistics::normalQuantile(1 - d.p / 2)) : t;
}

double worstZ(const support::TileEstimates& a, const support::TileEstimates& b)
{
    double worst = 0;
    for (size_t tile = 0; tile < a.tiles.size(); ++tile)
        for (size_t c = 0; c < 3; ++c) {
            const double z = zOf(a.tiles[tile][c], b.tiles[tile][c]);
            if (!(z <= worst)) worst = z; // also when it is not a number
        }
    return worst;
}

double meanOf(const support::PictureEstimates& picture)
{
    double sum = 0;
    for (const Estimate& channel : picture.whole.tiles.at(0)) sum += channel.mean / 3;
    return sum;
}

class Runs
{
  public:
    void add(const image::Image& run)
    {
        picture_.add(run);
        pixels_.resize(3 * run.pixels.size());
        for (size_t i = 0; i < run.pixels.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const double value = double(run.pixels[i][c]);
                nonFinite_ += !std::isfinite(value);
                pixels_[3 * i + size_t(c)].add(value);
                largest_ = std::max(largest_, value);
            }
    }

    Figures against(const support::PictureEstimates& truth, const passes::RenderStats& stats) const
    {
        Figures figures;
        figures.nonFinite = nonFinite_;
        for (const auto& [stage, count] : stats.nonFinite) figures.nonFinite += count;
        const support::PictureEstimates estimates = picture_.estimates();
        figures.z = std::max(worstZ(estimates.tiles, truth.tiles), worstZ(estimates.whole, truth.whole));
        const double mean = meanOf(estimates);
        double variance = 0;
        for (const Moments& pixel : pixels_) variance += pixel.variance() / double(pixels_.size());
        if (mean > 0) {
            figures.relativeVariance = variance / (mean * mean);
            figures.largest = largest_ / mean;
        }
        if (mean != meanOf(truth)) figures.meanOverTruth = mean / meanOf(truth);
        return figures;
    }

  private:
    support::PictureRuns picture_;
    std::vector<Moments> pixels_;
    uint64_t nonFinite_ = 0;
    double largest_ = 0;
};

Figures measure(gpu::Device& device, const ExtremeCase& extreme, passes::Method method,
                const support::PictureEstimates& truth)
{
    passes::Settings settings = extreme.settings;
    settings.method = method;
    settings.seed = 1000;
    const passes::CameraAt cameraAt = passes::cameraOrbit(extreme.scene.cameras.at(0), extreme.orbit);
    passes::Renderer renderer(device, extreme.scene, settings);
    Runs runs;
    const bool independent = method == passes::Method::Pt && !settings.average; // frames of the path tracer are runs
    passes::RenderStats stats;
    for (uint32_t run = 0; run < (independent ? extreme.runs * PT_FRAMES : extreme.runs); ++run) {
        if (independent) {
            renderer.setCamera(cameraAt(settings.frames - 1));
            renderer.renderFrame();
        } else {
            if (run > 0) ++settings.seed;
            renderer.apply(settings);
            renderer.reset();
            for (uint32_t frame = 0; frame < settings.frames; ++frame) {
                renderer.setCamera(cameraAt(frame));
                renderer.renderFrame();
            }
        }
        runs.add(renderer.read(passes::colorOf(renderer.settings())));
        if (independent) continue;
        for (const auto& [stage, count] : renderer.stats().nonFinite) stats.nonFinite[stage] += count;
    }
    return runs.against(truth, independent ? renderer.stats() : stats);
}

bool sound(const Figures& figures)
{
    return figures.nonFinite == 0 && figures.z < LIMIT;
}

std::vector<std::string> cellsOf(const Figures& f)
{
    return {std::to_string(f.nonFinite), fmt::format("{:.2f}", f.z), fmt::format("{:.3g}", f.relativeVariance),
            fmt::format("{:.3g}", f.largest), fmt::format("{:.4f}", f.meanOverTruth)};
}

const std::vector<std::string> FIGURES = {"not finite", "z", "variance", "largest", "mean / truth"};

std::vector<std::vector<std::string>> tableOf(const std::vector<Row>& rows)
{
    std::vector<std::vector<std::string>> table;
    for (const Row& row : rows)
        for (const auto& [method, figures] : row.methods) {
            table.push_back({row.extreme->name, row.extreme->stresses, method});
            std::ranges::copy(cellsOf(figures), std::back_inserter(table.back()));
        }
    return table;
}

std::vector<std::string> header()
{
    std::vector<std::string> names = {"case", "stresses", "method"};
    names.insert(names.end(), FIGURES.begin(), FIGURES.end());
    return names;
}

// One line a case: what all methods share, and z, variance and largest value of each.
std::string markdownOf(const std::vector<Row>& rows)
{
    std::string text = "| case | stresses | not finite |", rule = "|---|---|---|";
    for (const auto& [method, figures] : rows.at(0).methods) {
        text += fmt::format(" {0}: z | variance | largest |", method);
        rule += "---|---|---|";
    }
    text += "\n" + rule + "\n";
    for (const Row& row : rows) {
        uint64_t nonFinite = 0;
        std::string cells;
        for (const auto& [method, f] : row.methods) {
            nonFinite += f.nonFinite;
            cells += fmt::format(" {:.2f} | {:.2g} | {:.2g} |", f.z, f.relativeVariance, f.largest);
        }
        text += fmt::format("| {} | {} | {} |{}\n", row.extreme->name, row.extreme->stresses, nonFinite, cells);
    }
    return text;
}

constexpr const char* PAGE = R"({{> head.html}}
{{> verdicts.html}}
{{#table}}
{{> table.html}}
{{/table}}
<p>z: difference from the float64 reference or the closed form over its standard error, the worst of all tiles of 8x8
pixels, of the whole picture, and of the channels. variance: of a pixel in one run (ReSTIR: the last frame of a run; pt: a
frame), mean over the picture, over the square of the picture's mean. largest: the brightest pixel of any run over the
picture's mean.</p>
{{> provenance.html}}
{{> foot.html}}
)";

void write(const std::filesystem::path& file, const std::string& text)
{
    files::writeAtomically(file, std::as_bytes(std::span(text)));
}

void report(const std::filesystem::path& folder, const std::vector<Row>& rows, const gpu::Adapter& adapter)
{
    const std::vector<std::vector<std::string>> table = tableOf(rows);
    Csv csv(header());
    size_t unsound = 0;
    double worst = 0;
    for (const std::vector<std::string>& line : table) csv.row(line);
    for (const Row& row : rows)
        for (const auto& [method, figures] : row.methods) {
            unsound += !sound(figures);
            worst = std::max(worst, figures.z);
        }
    const std::string verdict =
        unsound == 0
            ? fmt::format("{} cases, {} with their methods: no value was not finite, and the worst |z| against the "
                          "truth is {:.2f} (limit {}).",
                          rows.size(), table.size(), worst, LIMIT)
            : fmt::format("{} of {} cases with their methods are not sound.", unsound, table.size());
    const ui::Provenance provenance{.command = ui::commandLine(),
                                    .scene = "of each case (tests/bench/extreme_cases.cpp)",
                                    .device = adapter.name,
                                    .driver = adapter.driver};
    write(folder / "extremes.csv", csv.text());
    write(folder / "extremes.html", ui::fillPage(PAGE, {{"title", "Extremes survived"},
                                                        {"verdicts", std::vector<std::string>{verdict}},
                                                        {"table", ui::tableData(header(), table)},
                                                        {"provenance", ui::provenanceData(provenance)}}));
    write(folder / "extremes.md", markdownOf(rows));
}

} // namespace

int main(int argc, char** argv)
try {
    CLI::App app("Every method in stiff and extreme cases, against float64.");
    std::filesystem::path folder = "build/extremes";
    std::string device = "llvmpipe", only, onlyMethod, shaders;
    bool quick = false;
    uint32_t times = 1;
    const std::map<std::string, passes::Method> methods = {
        {"pt", passes::Method::Pt}, {"restir-pt", passes::Method::RestirPt}, {"rgb-restir", passes::Method::RgbRestir}};
    app.add_option("-o,--output", folder, "Folder for extremes.csv, extremes.html, extremes.md (build/extremes)");
    app.add_option("--device", device, "Part of a device's name (llvmpipe)");
    app.add_option("--only", only, "Cases whose name contains this");
    app.add_option("--method", onlyMethod, "This method alone")->check(CLI::IsMember(methods));
    app.add_option("--times", times, "So many times the usual runs of each case (1)")->check(CLI::Range(1, 1000));
    app.add_option("--shaders", shaders, "Shader tree to compile in place of the built-in one: for planted errors");
    app.add_flag("--quick", quick, "A few of the cases");
    CLI11_PARSE(app, argc, argv);

    std::filesystem::create_directories(folder);
    gpu::Device gpu = gpu::Device::create({.adapter = device, .shaderDirectory = shaders});
    std::vector<ExtremeCase> cases = bench::extremeCases();
    for (ExtremeCase& extreme : cases) extreme.runs *= times;
    std::vector<Row> rows;
    bool allSound = true;
    for (const ExtremeCase& extreme : cases) {
        if (quick && !extreme.quick) continue;
        if (extreme.name.find(only) == std::string::npos) continue;
        scene::Scene last = extreme.scene; // as the last frame sees it
        last.cameras[0] = passes::cameraOrbit(last.cameras[0], extreme.orbit)(extreme.settings.frames - 1);
        const support::PictureEstimates truth = extreme.truth(last, extreme.settings);
        rows.push_back({&extreme, {}});
        for (const auto& [name, method] : methods) {
            if (!onlyMethod.empty() && name != onlyMethod) continue;
            const auto start = Clock::now();
            const Figures figures = measure(gpu, extreme, method, truth);
            rows.back().methods[name] = figures;
            allSound = allSound && sound(figures);
            std::printf(
                "%-44s %-11s %s  not finite %llu  z %.2f  variance %.3g  largest %.3g  mean/truth %.4f  %.1f s\n",
                extreme.name.c_str(), name.c_str(), sound(figures) ? "ok " : "BAD",
                static_cast<unsigned long long>(figures.nonFinite), figures.z, figures.relativeVariance,
                figures.largest, figures.meanOverTruth, secondsSince(start));
            std::fflush(stdout);
        }
        report(folder, rows, gpu.adapter());
    }
    if (rows.empty()) throw Error("No case has \"{}\" in its name.", only);
    return allSound ? 0 : 1;
} catch (const Error& error) {
    std::fprintf(stderr, "extremes: %s\n", error.what());
    return 1;
}
