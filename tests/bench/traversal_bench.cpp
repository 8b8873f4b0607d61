// Rays per second of the traversal on a Vulkan device beside Embree's on the CPU: the same rays, all interleaved in one
// run, medians. LOG.md says what was tried and what it gave.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "engine/base/clock.h"
#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/gpu/gpu.h"
#include "engine/gpu/shader.h"
#include "engine/scene/gpu_scene.h"

#include "shaders/shared/types.h"
#include "tests/bench/embree_apis.h"
#include "tests/bench/scenes.h"
#include "tests/support/ray_sets.h"

namespace
{

struct Options {
    std::string scene = "hall";
    std::string device;
    std::vector<std::string> shaders = {TRICHROME_SOURCE_DIR "/shaders"};
    uint32_t size = 512;
    uint32_t rounds = 9;
    uint32_t copies = 1;
    std::vector<std::string> sets = {"camera", "shadow", "bounce", "second bounce", "second shadow"};
    unsigned threads = std::max(1u, std::thread::hardware_concurrency());
    bool buildOnly = false;
    std::string json, csv;
};

// The scene's triangles again and again side by side: large scenes from small ones.
void repeat(scene::Scene& scene, uint32_t copies)
{
    glm::vec3 lower = scene.positions.at(0), upper = lower;
    for (const glm::vec3& p : scene.positions) lower = glm::min(lower, p), upper = glm::max(upper, p);
    const auto columns = uint32_t(std::ceil(std::sqrt(copies)));
    const size_t vertices = scene.positions.size(), triangles = scene.triangles.size();
    for (uint32_t copy = 1; copy < copies; ++copy) {
        const glm::vec3 shift = (upper - lower) * glm::vec3(copy % columns, 0, copy / columns);
        for (size_t i = 0; i < vertices; ++i) scene.positions.push_back(scene.positions[i] + shift);
        for (size_t i = 0; i < triangles; ++i) {
            scene::Triangle triangle = scene.triangles[i];
            for (uint32_t& vertex : triangle.vertices) vertex += uint32_t(copy * vertices);
            scene.triangles.push_back(triangle);
        }
    }
}

double secondsOf(const std::function<void()>& work)
{
    const auto start = Clock::now();
    work();
    return secondsSince(start);
}

rusage resources()
{
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return usage;
}

double peakMegabytes()
{
    return double(resources().ru_maxrss) / 1024;
}

// Of all threads: what other processes take does not count, so that on a busy machine ratios of it say more.
double processorSeconds()
{
    const rusage usage = resources();
    return double(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * double(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

double median(std::vector<double> values)
{
    std::ranges::sort(values);
    return values[values.size() / 2];
}

// Something that traces one set of rays, and how long it took in each round.
struct Contestant {
    std::string name;
    bool ours = false;
    std::function<void()> prepare;
    std::function<void()> run;
    std::function<size_t()> hits;
    std::vector<double> seconds;          // wall
    std::vector<double> processorSeconds; // of software drivers too; tells nothing about a GPU
};

class Kernels
{
  public:
    Kernels(gpu::Device& device, const scene::Bvh& bvh, const std::vector<std::string>& trees)
        : device_(device), nodes_(upload("nodes", std::as_bytes(std::span(bvh.nodes)), gpu::Usage::Table)),
          triangles_(upload("triangles", std::as_bytes(std::span(bvh.triangles)), gpu::Usage::Table)),
          stack_(scene::traversalStack(device.adapter(), bvh.stats))
    {
        for (const std::string& tree : trees)
            for (const uint32_t any : {0u, 1u}) pipelines_.push_back(compile(tree, any));
    }

    Contestant contestant(const std::string& name, size_t tree, bool anyHit, const std::vector<TestRay>& rays)
    {
        struct State {
            gpu::Buffer rays, hits;
            gpu::BindGroup scene, pass;
        };
        const gpu::ComputePipeline& pipeline = pipelines_[2 * tree + (anyHit ? 1 : 0)];
        auto state = std::make_shared<State>();
        state->rays = upload("rays", std::as_bytes(std::span(rays)), gpu::Usage::Table);
        state->hits = device_.createBuffer({.label = "hits", .size = rays.size() * sizeof(glm::uvec4)});
        state->scene =
            device_.createBindGroup({"scene", &pipeline, SET_SCENE, {{"Nodes", &nodes_}, {"Triangles", &triangles_}}});
        state->pass =
            device_.createBindGroup({"pass", &pipeline, SET_PASS, {{"Rays", &state->rays}, {"Hits", &state->hits}}});
        Contestant result = {.name = name, .ours = true, .prepare = [] {}};
        result.run = [this, state, &pipeline, count = uint32_t(rays.size())] {
            gpu::CommandEncoder encoder = device_.createCommandEncoder("bench");
            encoder.dispatch({&pipeline, {nullptr, &state->scene, &state->pass}, {count}});
            device_.queue().wait(device_.queue().submit(std::move(encoder)));
        };
        result.hits = [this, state] {
            const auto hits = device_.queue().readAs<glm::uvec4>(state->hits);
            return size_t(std::ranges::count_if(hits, [](const glm::uvec4& h) { return h.x != 0xffffffffu; }));
        };
        return result;
    }

  private:
    gpu::Buffer upload(const char* label, std::span<const std::byte> bytes, gpu::Usage usage)
    {
        gpu::Buffer buffer = device_.createBuffer({.label = label, .size = bytes.size(), .usage = usage});
        device_.queue().write(buffer, bytes);
        return buffer;
    }

    gpu::ComputePipeline compile(const std::string& tree, uint32_t anyHit)
    {
        const bool texel = device_.adapter().tuning.tables == gpu::Tuning::Tables::Texel;
        const std::vector<uint32_t> spirv =
            gpu::compileShader(TRICHROME_SOURCE_DIR "/tests/bench/traversal_bench.comp", tree, texel);
        const std::filesystem::path file = std::filesystem::temp_directory_path() / fmt::format("bench-{}", getpid());
        const std::string flavored = file.string() + (texel ? ".texel.spv" : ".storage.spv");
        files::writeAtomically(flavored, std::as_bytes(std::span(spirv)));
        gpu::ComputePipeline pipeline =
            device_.createComputePipeline({anyHit ? "any hit" : "closest hit",
                                           file.string(),
                                           {{"ANY_HIT", anyHit},
                                            {"STACK_SIZE", stack_.entries},
                                            {"STACK_IN_REGISTERS", stack_.inRegisters ? 1u : 0u}}});
        std::filesystem::remove(flavored);
        return pipeline;
    }

    gpu::Device& device_;
    gpu::Buffer nodes_, triangles_;
    scene::TraversalStack stack_;
    std::vector<gpu::ComputePipeline> pipelines_; // per tree: closest hit, any hit
};

struct RaySet {
    const char* name;
    const std::vector<TestRay>* rays;
    bool anyHit;
};

void race(std::vector<Contestant>& contestants, uint32_t rounds)
{
    std::vector<size_t> hits;
    for (uint32_t round = 0; round <= rounds; ++round) // the first warms up: drivers compile at first use
        for (Contestant& c : contestants) {
            c.prepare();
            c.run(); // caches are full of the scene as the contestant before had it
            c.prepare();
            const double before = processorSeconds();
            const double seconds = secondsOf(c.run);
            if (round == 0) {
                hits.push_back(c.hits());
                continue;
            }
            c.seconds.push_back(seconds);
            c.processorSeconds.push_back(processorSeconds() - before);
        }
    for (size_t i = 0; i < hits.size(); ++i)
        if (std::abs(double(hits[i]) - double(hits[0])) > 1e-3 * double(hits[0]))
            throw Error("{} found {} hits where {} found {}: no figure of this run means anything.",
                        contestants[i].name, hits[i], contestants[0].name, hits[0]);
}

nlohmann::json report(const RaySet& set, const std::vector<Contestant>& contestants)
{
    // Embree's best time and its one-ray API's, of one kind of seconds.
    using Seconds = std::vector<double> Contestant::*;
    const auto best = [&](Seconds kind) {
        double least = std::numeric_limits<double>::infinity();
        for (const Contestant& c : contestants)
            if (!c.ours) least = std::min(least, median(c.*kind));
        return least;
    };
    const auto single = std::ranges::find(contestants, false, &Contestant::ours);
    nlohmann::json rows;
    fmt::print("{:44} Mrays/s   of Embree's best (processor time)   of its one-ray API (processor time)\n",
               fmt::format("{}, {} rays", set.name, set.rays->size()));
    for (const Contestant& c : contestants) {
        const double rate = 1e-6 * double(set.rays->size()) / median(c.seconds);
        const auto ratios = [&](Seconds kind) {
            return std::pair(best(kind) / median(c.*kind), median((*single).*kind) / median(c.*kind));
        };
        const auto [toBest, toSingle] = ratios(&Contestant::seconds);
        const auto [toBestWork, toSingleWork] = ratios(&Contestant::processorSeconds);
        fmt::print("  {:40} {:9.2f} {:10.3f} ({:5.3f}) {:26.3f} ({:5.3f})\n", c.name, rate, toBest, toBestWork,
                   toSingle, toSingleWork);
        rows.push_back({{"set", set.name},
                        {"rays", set.rays->size()},
                        {"contestant", c.name},
                        {"mrays_per_second", rate},
                        {"of_best", toBest},
                        {"of_single", toSingle},
                        {"of_best_processor", toBestWork},
                        {"of_single_processor", toSingleWork},
                        {"seconds", c.seconds}});
    }
    return rows;
}

void writeText(const std::string& path, const std::string& text)
{
    if (!path.empty()) files::writeAtomically(path, std::as_bytes(std::span(text)));
}

std::string csvOf(const nlohmann::json& rows)
{
    std::string csv = "set,rays,contestant,mrays_per_second,of_best,of_single,of_best_processor\n";
    for (const auto& row : rows)
        csv += fmt::format("{},{},\"{}\",{},{},{},{}\n", row["set"].get<std::string>(), row["rays"].get<size_t>(),
                           row["contestant"].get<std::string>(), row["mrays_per_second"].get<double>(),
                           row["of_best"].get<double>(), row["of_single"].get<double>(),
                           row["of_best_processor"].get<double>());
    return csv;
}

void run(const Options& options)
{
    scene::Scene scene = loadScene(options.scene);
    repeat(scene, options.copies);
    gpu::Device device = gpu::Device::create({.adapter = options.device});
    const double before = peakMegabytes();
    const scene::Bvh bvh =
        scene::buildBvh({.positions = scene.positions, .triangles = scene.triangles}, device.limits().tableBytes);
    const scene::BvhStats& stats = bvh.stats;
    fmt::print("{}: {} triangles, {} records, {} nodes, {:.1f} bytes a triangle, SAH cost {:.2f}, depth {}, built in "
               "{:.2f} s, peak memory {:.0f} MB before and {:.0f} MB after\n{} on {} threads\n",
               options.scene, scene.triangles.size(), stats.triangleRecords, stats.nodes,
               double(stats.bytes) / double(scene.triangles.size()), stats.sahCost, stats.depth, stats.buildSeconds,
               before, peakMegabytes(), device.adapter().name, options.threads);
    nlohmann::json results = {{"scene", options.scene},
                              {"triangles", scene.triangles.size()},
                              {"records", stats.triangleRecords},
                              {"nodes", stats.nodes},
                              {"bytes", stats.bytes},
                              {"sah_cost", stats.sahCost},
                              {"build_seconds", stats.buildSeconds},
                              {"peak_megabytes", peakMegabytes()},
                              {"device", device.adapter().name},
                              {"threads", options.threads}};
    if (!options.buildOnly) {
        const EmbreeScene embree(scene.positions, scene.triangles);
        const RaySets rays = makeRaySets(scene, embree, options.size);
        Kernels kernels(device, bvh, options.shaders);
        nlohmann::json rows = nlohmann::json::array();
        for (const RaySet& set : {RaySet{"camera", &rays.camera, false}, RaySet{"shadow", &rays.shadow, true},
                                  RaySet{"bounce", &rays.bounce, false}, RaySet{"second bounce", &rays.bounce2, false},
                                  RaySet{"second shadow", &rays.shadow2, true}}) {
            if (std::ranges::find(options.sets, set.name) == options.sets.end()) continue;
            std::vector<Contestant> contestants;
            for (size_t i = 0; i < options.shaders.size(); ++i)
                contestants.push_back(kernels.contestant(options.shaders[i], i, set.anyHit, *set.rays));
            for (const EmbreeApi& api : embreeApis(embree, *set.rays, set.anyHit, options.threads))
                contestants.push_back({.name = api.name, .prepare = api.prepare, .run = api.run, .hits = api.hits});
            race(contestants, options.rounds);
            for (const auto& row : report(set, contestants)) rows.push_back(row);
        }
        results["rows"] = rows;
        writeText(options.csv, csvOf(rows));
    }
    writeText(options.json, results.dump(1));
}

} // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App app("Rays per second of the traversal shaders beside Embree, on the same rays and cores");
    app.add_option("scene", options.scene, "a .gltf or .glb file, or the name of a built-in scene (hall)");
    app.add_option("--device", options.device, "Vulkan device: index or part of its name");
    app.add_option("--shaders", options.shaders, "shader trees to compare in one run (this checkout's)");
    app.add_option("--size", options.size, "camera rays: SIZE x SIZE, a power of two (512)");
    app.add_option("--sets", options.sets, "the sets of rays to trace (all)")->check(CLI::IsMember(options.sets));
    app.add_option("--rounds", options.rounds, "timed rounds; medians are reported (9)")->check(CLI::PositiveNumber);
    app.add_option("--copies", options.copies, "of the scene, side by side (1)")->check(CLI::PositiveNumber);
    app.add_option("--threads", options.threads, "Embree's (all cores)")->check(CLI::PositiveNumber);
    app.add_flag("--build-only", options.buildOnly, "only builds the tree and reports on it");
    app.add_option("--json", options.json, "all figures");
    app.add_option("--csv", options.csv, "the table");
    CLI11_PARSE(app, argc, argv);
    try {
        run(options);
    } catch (const Error& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
    return 0;
}
