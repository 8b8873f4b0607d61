// What a frame costs: device milliseconds and rays per stage for each method and shift map, all interleaved in one run,
// medians over rounds. LOG.md says what was tried and what it gave.

#include <algorithm>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/gpu/gpu.h"
#include "passes/camera_path.h"
#include "passes/renderer.h"
#include "tests/bench/scenes.h"

namespace
{

struct Options {
    std::vector<std::string> scenes = {"cornell", "hall", "lamps", "dim"};
    std::string device;
    std::string size = "320x180";
    uint32_t spatial = 3;
    double orbit = 0.3; // degrees a frame; 0: the camera rests
    uint32_t rounds = 5;
    uint32_t frames = 8;
    uint32_t reference = 0; // frames of the path traced picture that errors are measured against; 0: no errors
    std::string json;
};

struct Case {
    std::string method;
    std::string shift;
    std::unique_ptr<passes::Renderer> renderer;
    std::map<std::string, std::vector<double>> milliseconds; // by stage, of every round
    passes::RenderStats stats;                               // of the last round
    std::vector<double> errors;                              // relative MSE of the last frame, of every round
};

double mean(const std::vector<double>& values)
{
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / double(values.size());
}

double median(std::vector<double> values)
{
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// Mean over pixels and channels of (a - r)^2 / (r^2 + 1e-4 m^2), m the mean of r: pixels count alike, black ones
// finitely.
double relativeError(const image::Image& picture, const image::Image& reference)
{
    double mean = 0, sum = 0;
    for (const glm::vec3& r : reference.pixels) mean += double(r.r) + r.g + r.b;
    mean /= 3 * double(reference.pixels.size());
    for (size_t p = 0; p < reference.pixels.size(); ++p)
        for (int c = 0; c < 3; ++c) {
            const double r = reference.pixels[p][c], difference = picture.pixels[p][c] - r;
            sum += difference * difference / (r * r + 1e-4 * mean * mean);
        }
    return sum / (3 * double(reference.pixels.size()));
}

image::Image tracedReference(gpu::Device& device, const scene::Scene& scene, const scene::Camera& camera,
                             const Options& options)
{
    passes::Settings settings;
    passes::set(settings, "size", options.size);
    settings.seed = 1u << 30;
    passes::Renderer renderer(device, scene, settings);
    renderer.setCamera(camera);
    for (uint32_t frame = 0; frame < options.reference; ++frame) renderer.renderFrame();
    return renderer.readMean();
}

void runRound(Case& c, const passes::CameraAt& cameraAt, const Options& options, const image::Image& reference,
              uint32_t round)
{
    passes::Settings settings = c.renderer->settings();
    settings.seed = round;
    c.renderer->apply(settings);
    c.renderer->setCamera(cameraAt(0));
    c.renderer->reset();
    for (uint32_t frame = 0; frame < options.frames; ++frame) {
        c.renderer->setCamera(cameraAt(frame));
        c.renderer->renderFrame();
    }
    c.stats = c.renderer->stats();
    if (round == 0) return; // drivers compile at the first dispatch
    if (options.reference > 0) c.errors.push_back(relativeError(c.renderer->readFrame(), reference));
    for (const auto& [stage, ms] : c.stats.stageMilliseconds) c.milliseconds[stage].push_back(ms);
}

nlohmann::ordered_json report(const std::string& scene, const std::vector<Case>& cases, const Options& options)
{
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    std::map<std::string, double> baseline; // of restir-pt, by shift
    const auto totalOf = [](const Case& c) {
        double total = 0;
        for (const auto& [stage, ms] : c.milliseconds) total += median(ms);
        return total;
    };
    for (const Case& c : cases)
        if (c.method == "restir-pt") baseline[c.shift] = totalOf(c);
    const double pt = totalOf(cases.front());
    fmt::print("{} ({}, K = {}, {} degrees a frame)\n", scene, options.size, options.spatial, options.orbit);
    for (const Case& c : cases) {
        const double total = totalOf(c);
        uint64_t rays = 0;
        for (const auto& [kind, count] : c.stats.rays) rays += count;
        const double perPixel =
            double(rays) / (double(c.renderer->settings().width) * c.renderer->settings().height * options.frames);
        nlohmann::ordered_json row = {
            {"scene", scene},       {"method", c.method},       {"shift", c.shift},
            {"ms", total},          {"to_pt", total / pt},      {"rays_per_pixel", perPixel},
            {"rays", c.stats.rays}, {"shifts", c.stats.shifts}, {"trees_per_pixel", c.stats.treesPerPixel}};
        std::string stages, ratio;
        for (const auto& [stage, ms] : c.milliseconds) {
            row["stage_ms"][stage] = median(ms);
            stages += fmt::format(" {} {:.1f}", stage, median(ms));
        }
        if (c.method == "rgb-restir") {
            row["to_restir_pt"] = total / baseline.at(c.shift);
            ratio = fmt::format(", {:.2f} of restir-pt, {:.2f} trees/pixel", total / baseline.at(c.shift),
                                c.stats.treesPerPixel);
        }
        if (!c.errors.empty()) {
            // The path tracer's mean over as many frames as fit into this case's time.
            const double error = mean(c.errors), inTime = mean(cases.front().errors) * pt / total;
            row["relmse"] = error;
            row["relmse_pt_same_time"] = inTime;
            ratio += fmt::format("; relative MSE {:.4g}, pt in that time {:.4g}", error, inTime);
        }
        fmt::print("  {:<10} {:<12} {:8.1f} ms, {:5.2f} of pt, {:5.1f} rays/pixel{}; ms:{}\n", c.method, c.shift, total,
                   total / pt, perPixel, ratio, stages);
        rows.push_back(std::move(row));
    }
    return rows;
}

void run(const Options& options)
{
    gpu::Device device = gpu::Device::create({.adapter = options.device});
    fmt::print("{}, {}; medians of {} rounds of {} frames\n", device.adapter().name, device.adapter().driver,
               options.rounds, options.frames);
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const std::string& name : options.scenes) {
        const scene::Scene scene = loadScene(name);
        const passes::CameraAt cameraAt = passes::cameraOrbit(scene.cameras.at(0), options.orbit);
        std::vector<Case> cases;
        const auto add = [&](const std::string& method, const std::string& shift) {
            passes::Settings settings;
            passes::set(settings, "method", method);
            passes::set(settings, "shift", shift);
            passes::set(settings, "size", options.size);
            passes::set(settings, "spatial", std::to_string(options.spatial));
            cases.push_back({.method = method,
                             .shift = shift,
                             .renderer = std::make_unique<passes::Renderer>(device, scene, settings)});
        };
        add("pt", "replay");
        for (const char* shift : {"replay", "reconnection", "hybrid"})
            for (const char* method : {"restir-pt", "rgb-restir"}) add(method, shift);
        image::Image reference;
        if (options.reference > 0) reference = tracedReference(device, scene, cameraAt(options.frames - 1), options);
        for (uint32_t round = 0; round <= options.rounds; ++round)
            for (Case& c : cases) runRound(c, cameraAt, options, reference, round);
        for (auto& row : report(name, cases, options)) rows.push_back(row);
    }
    if (options.json.empty()) return;
    const std::string text = rows.dump(2) + "\n";
    files::writeAtomically(options.json, std::as_bytes(std::span(text)));
}

} // namespace

int main(int count, char** arguments)
{
    Options options;
    CLI::App app("Milliseconds and rays of every stage, for each method and shift map.");
    app.add_option("scenes", options.scenes, "built-in names or .gltf/.glb files");
    app.add_option("--device", options.device, "index or part of a name");
    app.add_option("--size", options.size, "WxH, pixels");
    app.add_option("--spatial", options.spatial, "neighbors");
    app.add_option("--orbit", options.orbit, "degrees per frame; 0: the camera rests");
    app.add_option("--rounds", options.rounds, "rounds that count")->check(CLI::PositiveNumber);
    app.add_option("--frames", options.frames, "frames of a round")->check(CLI::PositiveNumber);
    app.add_option("--reference", options.reference,
                   "also errors of the last frame, against this many path traced frames");
    app.add_option("--json", options.json, "also write the figures here");
    CLI11_PARSE(app, count, arguments);
    try {
        run(options);
    } catch (const Error& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
    return 0;
}
