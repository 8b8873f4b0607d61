// What a frame costs: device milliseconds and rays per stage for each method and shift map, all interleaved in one run,
// medians over rounds; ratios are medians of each round's ratio. LOG.md says what was tried and what it gave.

#include <algorithm>
#include <ctime>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/gpu/gpu.h"
#include "engine/image/metrics.h"
#include "passes/camera_path.h"
#include "passes/renderer.h"
#include "tests/bench/scenes.h"

namespace
{

struct Options {
    std::vector<std::string> scenes = {"cornell", "hall", "lamps", "dim"};
    std::vector<std::string> shifts = {"replay", "reconnection", "hybrid"};
    std::vector<std::string> colors = {
        "weighted"};                         // how restir-pt's is read; the first is what others are compared with
    std::vector<std::string> shaders = {""}; // folders of shader trees that race; empty: the built-in one
    std::vector<std::string> tunings = {""}; // of the device, which race, too; empty: what its class gets
    std::string device;
    std::string size = "320x180";
    uint32_t spatial = 3;
    double orbit = 0.3; // degrees a frame; 0: the camera rests
    uint32_t rounds = 5;
    uint32_t frames = 8;
    uint32_t reference = 0; // frames of the path traced picture that errors are measured against; 0: no errors
    std::string features;   // a method: instead of all that, what it costs to compile in what a scene does not need
    std::string json;
};

struct Case {
    std::string shaders; // and tuning; or what is compiled in beyond need
    std::string method;  // or "restir-pt:COLOR"
    std::string shift;
    std::unique_ptr<passes::Renderer> renderer;
    std::map<std::string, std::vector<double>> milliseconds; // by stage, of every round
    std::vector<double> totals;                              // of all stages, of every round
    std::vector<double> processor;      // the program's processor time, which other programs disturb less
    passes::RenderStats stats;          // of the last round
    std::vector<image::Metrics> errors; // of the last frame, of every round
};

double mean(const std::vector<image::Metrics>& list, double image::Metrics::*figure)
{
    double sum = 0;
    for (const image::Metrics& metrics : list) sum += metrics.*figure;
    return sum / double(list.size());
}

double median(std::vector<double> values)
{
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
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
    return renderer.read(passes::MEAN);
}

void runRound(Case& c, const passes::CameraAt& cameraAt, const Options& options, const image::Image& reference,
              uint32_t round)
{
    passes::Settings settings = c.renderer->settings();
    settings.seed = round;
    c.renderer->apply(settings);
    c.renderer->setCamera(cameraAt(0));
    c.renderer->reset();
    const std::clock_t start = std::clock();
    for (uint32_t frame = 0; frame < options.frames; ++frame) {
        c.renderer->setCamera(cameraAt(frame));
        c.renderer->renderFrame();
    }
    c.renderer->wait();
    const double processor = double(std::clock() - start) / CLOCKS_PER_SEC;
    c.stats = c.renderer->stats();
    if (round == 0) return; // drivers compile at the first dispatch
    if (options.reference > 0) c.errors.push_back(image::measure(reference, c.renderer->read(passes::LAST_FRAME)));
    double total = 0;
    for (const auto& [stage, ms] : c.stats.stageMilliseconds) {
        c.milliseconds[stage].push_back(ms);
        total += ms;
    }
    c.totals.push_back(total);
    c.processor.push_back(processor);
}

double medianRatio(const std::vector<double>& over, const std::vector<double>& under)
{
    std::vector<double> ratios;
    for (size_t round = 0; round < over.size(); ++round) ratios.push_back(over[round] / under[round]);
    return median(ratios);
}

nlohmann::ordered_json report(const std::string& scene, const std::vector<Case>& cases, const Options& options)
{
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    const auto find = [&](const std::string& shaders, const std::string& method,
                          const std::string& shift) -> const Case& {
        return *std::ranges::find_if(
            cases, [&](const Case& c) { return c.shaders == shaders && c.method == method && c.shift == shift; });
    };
    fmt::print("{} ({}, K = {}, {} degrees a frame)\n", scene, options.size, options.spatial, options.orbit);
    for (const Case& c : cases) {
        const double total = median(c.totals), toPt = medianRatio(c.totals, find(c.shaders, "pt", "replay").totals);
        uint64_t rays = 0;
        for (const auto& [kind, count] : c.stats.rays) rays += count;
        const double perPixel =
            double(rays) / (double(c.renderer->settings().width) * c.renderer->settings().height * options.frames);
        nlohmann::ordered_json row = {{"scene", scene},
                                      {"shaders", c.shaders},
                                      {"method", c.method},
                                      {"shift", c.shift},
                                      {"ms", total},
                                      {"to_pt", toPt},
                                      {"rays_per_pixel", perPixel},
                                      {"rays", c.stats.rays},
                                      {"shifts", c.stats.shifts},
                                      {"trees_per_pixel", c.stats.treesPerPixel}};
        std::string stages, ratio;
        for (const auto& [stage, ms] : c.milliseconds) {
            row["stage_ms"][stage] = median(ms);
            stages += fmt::format(" {} {:.1f}", stage, median(ms));
        }
        if (c.method != "pt" && c.method != "restir-pt") {
            const Case& one = find(c.shaders, "restir-pt", c.shift);
            row["to_restir_pt"] = medianRatio(c.totals, one.totals);
            row["processor_to_restir_pt"] = medianRatio(c.processor, one.processor);
            ratio =
                fmt::format(", {:.2f} of restir-pt ({:.2f} by processor time), {:.2f} trees/pixel",
                            double(row["to_restir_pt"]), double(row["processor_to_restir_pt"]), c.stats.treesPerPixel);
        }
        if (c.shaders != cases.front().shaders) {
            const Case& first = find(cases.front().shaders, c.method, c.shift);
            row["to_first_shaders"] = medianRatio(c.totals, first.totals);
            row["processor_to_first_shaders"] = medianRatio(c.processor, first.processor);
            ratio += fmt::format(", {:.3f} of the first shaders ({:.3f} by processor time)",
                                 double(row["to_first_shaders"]), double(row["processor_to_first_shaders"]));
        }
        if (!c.errors.empty()) {
            // The path tracer's mean over as many frames as fit into this case's time.
            const double error = mean(c.errors, &image::Metrics::relmse), psnr = mean(c.errors, &image::Metrics::psnr),
                         chroma = mean(c.errors, &image::Metrics::chromaMse),
                         inTime = mean(cases.front().errors, &image::Metrics::relmse) / toPt;
            row["relmse"] = error;
            row["relmse_pt_same_time"] = inTime;
            row["psnr"] = psnr;
            row["chroma_mse"] = chroma;
            ratio += fmt::format("; relative MSE {:.4g}, pt in that time {:.4g}, PSNR {:.2f} dB, chroma MSE {:.3g}",
                                 error, inTime, psnr, chroma);
        }
        fmt::print("  {}{:<10} {:<12} {:8.1f} ms, {:5.2f} of pt, {:5.1f} rays/pixel{}; ms:{}\n",
                   c.shaders.empty() ? "" : c.shaders + " ", c.method, c.shift, total, toPt, perPixel, ratio, stages);
        rows.push_back(std::move(row));
    }
    return rows;
}

// The features that the shaders know, by name.
std::vector<std::pair<std::string, bool passes::Variant::*>> allFeatures()
{
    std::vector<std::pair<std::string, bool passes::Variant::*>> list;
    const auto add = [&](const std::string& name, auto member) {
        if constexpr (std::is_same_v<decltype(member), bool passes::Variant::*>)
            if (name.starts_with("HAS_")) list.emplace_back(name, member);
    };
#define ADD_FEATURE(ID, TYPE, NAME, DEFAULT, WHAT) add(#NAME, &passes::Variant::NAME);
    VARIANT_CONSTANTS(ADD_FEATURE)
#undef ADD_FEATURE
    return list;
}

// What the scene needs, everything, and each feature that it does not need alone.
nlohmann::ordered_json raceFeatures(gpu::Device& device, const std::string& name, const Options& options)
{
    const scene::Scene scene = loadScene(name);
    const passes::CameraAt cameraAt = passes::cameraOrbit(scene.cameras.at(0), options.orbit);
    passes::Settings settings;
    passes::set(settings, "method", options.features);
    passes::set(settings, "shift", options.shifts.back());
    passes::set(settings, "size", options.size);
    passes::set(settings, "spatial", std::to_string(options.spatial));
    std::vector<Case> cases;
    const auto add = [&](const std::string& label, scene::FeatureSet set) -> passes::Renderer& {
        cases.push_back({.shaders = label,
                         .method = options.features,
                         .shift = options.shifts.back(),
                         .renderer = std::make_unique<passes::Renderer>(device, scene, settings,
                                                                        passes::SceneOptions{.featureSet = set})});
        return *cases.back().renderer;
    };
    const passes::Renderer& needed = add("needed", scene::FeatureSet::Needed);
    const passes::Variant variant = needed.variant();
    add("everything", scene::FeatureSet::Everything);
    for (const auto& [feature, member] : allFeatures()) {
        // Colors are rows of the tables, which scenes without them lack.
        if (variant.*member || feature == "HAS_VERTEX_COLORS") continue;
        passes::Renderer& renderer = add(feature, scene::FeatureSet::Needed);
        for (const auto& [stage, constants] : passes::stagesOf(renderer.scene(), {&settings, 1}, options.orbit != 0)) {
            passes::Variant more = constants;
            more.*member = true;
            renderer.pipelines()->put(
                stage, constants, device.createComputePipeline({.label = stage, .constants = passes::constants(more)}));
        }
        renderer.recompile();
    }
    for (uint32_t round = 0; round <= options.rounds; ++round)
        for (Case& c : cases) runRound(c, cameraAt, options, {}, round);

    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    fmt::print("{} ({}, {})\n", name, options.size, options.features);
    for (const Case& c : cases) {
        const double time = medianRatio(c.totals, cases[0].totals),
                     processor = medianRatio(c.processor, cases[0].processor);
        fmt::print("  {:<32} {:8.1f} ms, {:.3f} of what is needed ({:.3f} by processor time)\n", c.shaders,
                   median(c.totals), time, processor);
        rows.push_back({{"scene", name},
                        {"method", c.method},
                        {"compiled_in", c.shaders},
                        {"ms", median(c.totals)},
                        {"to_needed", time},
                        {"processor_to_needed", processor}});
    }
    return rows;
}

void run(const Options& options)
{
    std::vector<gpu::Device> devices; // one for each contestant
    std::vector<std::string> contestants;
    for (const std::string& shaders : options.shaders)
        for (const std::string& tuning : options.tunings) {
            devices.push_back(
                gpu::Device::create({.adapter = options.device, .tuning = tuning, .shaderDirectory = shaders}));
            contestants.push_back(shaders.empty() || tuning.empty() ? shaders + tuning : shaders + " " + tuning);
        }
    fmt::print("{}, {}; medians of {} rounds of {} frames\n", devices[0].adapter().name, devices[0].adapter().driver,
               options.rounds, options.frames);
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const std::string& name : options.scenes) {
        if (!options.features.empty()) {
            for (auto& row : raceFeatures(devices[0], name, options)) rows.push_back(row);
            continue;
        }
        const scene::Scene scene = loadScene(name);
        const passes::CameraAt cameraAt = passes::cameraOrbit(scene.cameras.at(0), options.orbit);
        std::vector<Case> cases;
        for (size_t tree = 0; tree < devices.size(); ++tree) {
            const passes::Renderer* sibling = nullptr;
            const auto add = [&](const std::string& method, const std::string& shift, const std::string& color) {
                passes::Settings settings;
                passes::set(settings, "color", color);
                passes::set(settings, "method", method);
                passes::set(settings, "shift", shift);
                passes::set(settings, "size", options.size);
                passes::set(settings, "spatial", std::to_string(options.spatial));
                auto renderer = sibling ? std::make_unique<passes::Renderer>(*sibling, settings)
                                        : std::make_unique<passes::Renderer>(devices[tree], scene, settings);
                if (!sibling) sibling = renderer.get();
                cases.push_back(
                    {.shaders = contestants[tree],
                     .method = method == "restir-pt" && color != options.colors[0] ? method + ":" + color : method,
                     .shift = shift,
                     .renderer = std::move(renderer)});
            };
            add("pt", "replay", options.colors[0]);
            for (const std::string& shift : options.shifts) {
                for (const std::string& color : options.colors) add("restir-pt", shift, color);
                add("rgb-restir", shift, options.colors[0]);
            }
        }
        image::Image reference;
        if (options.reference > 0)
            reference = tracedReference(devices[0], scene, cameraAt(options.frames - 1), options);
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
    app.add_option("--shifts", options.shifts, "shift maps")
        ->check(CLI::IsMember({"replay", "reconnection", "hybrid"}));
    app.add_option("--colors", options.colors, "how restir-pt's color is read")
        ->check(CLI::IsMember({"chosen", "weighted", "variate"}));
    app.add_option("--shaders", options.shaders, "folders of shader trees, raced against each other");
    app.add_option("--tunings", options.tunings, "NAME=VALUE,... of the device, raced against each other; '': none");
    app.add_option("--device", options.device, "index or part of a name");
    app.add_option("--size", options.size, "WxH, pixels");
    app.add_option("--spatial", options.spatial, "neighbors");
    app.add_option("--orbit", options.orbit, "degrees per frame; 0: the camera rests");
    app.add_option("--rounds", options.rounds, "rounds that count")->check(CLI::PositiveNumber);
    app.add_option("--frames", options.frames, "frames of a round")->check(CLI::PositiveNumber);
    app.add_option("--reference", options.reference,
                   "also errors of the last frame, against this many path traced frames");
    app.add_option("--features", options.features,
                   "a method; instead of all that, what it costs to compile in what the scenes do not need")
        ->check(CLI::IsMember({"pt", "restir-pt", "rgb-restir"}));
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
