// What it costs that a scene moves: on the host, for a hundred bodies and for a mesh that a skin deforms; and on the
// device, a frame of such a scene beside the same frame at rest and under a camera that moves. Interleaved in one run,
// medians over rounds. LOG.md says what it gave.

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/base/clock.h"
#include "engine/base/error.h"
#include "engine/gpu/gpu.h"
#include "engine/scene/motion_builder.h"
#include "engine/scene/procedural.h"
#include "engine/scene/shapes.h"
#include "passes/sequence.h"

namespace
{

constexpr double PERIOD = 8; // s

double median(std::vector<double> values)
{
    std::ranges::sort(values);
    return values.empty() ? 0 : values[values.size() / 2];
}

// The hall with a hundred turning bodies, a tenth of what one sees. Copied or stored once.
scene::Scene hallWithBodies(bool storedOnce)
{
    scene::Scene scene = scene::makeHall();
    const uint32_t paint = scene::addMaterial(scene, scene::glossy("body", {0.7f, 0.6f, 0.3f}, 0.4f));
    scene::MotionBuilder builder(scene, PERIOD);
    scene::Scene shape;
    scene::addSphere(shape, scene::addMaterial(shape, {}), {0.15f, 0, 0}, 0.25f, 1);
    const uint32_t mesh = storedOnce ? builder.storeMesh(shape, paint) : builder.addMesh(shape);
    for (int i = 0; i < 100; ++i) {
        const int row = i / 10;
        const glm::dvec3 place(double(i % 10) - 4.5, 0.6 + 0.25 * (i % 7), 1.2 * row - 6.0);
        const uint32_t node = builder.addNode({.translation = place});
        if (storedOnce)
            builder.addInstance(node, mesh);
        else
            builder.addPart(node, mesh, paint);
        builder.turn(node, {0, 1, 0}, 1 + i % 3);
    }
    builder.finish();
    return scene;
}

// A banner of 10^5 triangles on twenty joints.
scene::Scene skinnedBanner()
{
    scene::Scene scene = scene::makeHall();
    const uint32_t cloth = scene::addMaterial(scene, scene::diffuse("cloth", {0.8f, 0.2f, 0.2f}));
    scene::MotionBuilder builder(scene, PERIOD);
    scene::Scene shape;
    scene::addSurface(shape, scene::addMaterial(shape, {}), {.columns = 500, .rows = 100},
                      [](float s, float t) { return glm::vec3(6 * s - 3, 1 + t, 0); });
    const uint32_t mesh = builder.addMesh(shape);
    std::vector<uint32_t> joints;
    for (int i = 0; i < 20; ++i) {
        joints.push_back(
            builder.addNode({.translation = {i == 0 ? -3.0 : 0.3, 0, 0}}, i == 0 ? scene::NONE : joints.back()));
        builder.rotate(joints.back(), 16, [i](double phase) {
            return glm::angleAxis(0.15 * std::sin(2 * 3.14159265358979 * phase + 0.5 * i), glm::dvec3(0, 1, 0));
        });
    }
    const uint32_t part = builder.addPart(builder.addNode({}), mesh, cloth);
    builder.bind(part, joints, [](const glm::dvec3& p) {
        const double at = std::clamp((p.x + 3) / 0.3, 0.0, 18.99);
        const auto joint = uint32_t(at);
        return std::vector<scene::Influence>{{joint, float(1 - (at - joint))}, {joint + 1, float(at - joint)}};
    });
    builder.finish();
    return scene;
}

struct Options {
    std::string device, size = "320x180";
    uint32_t rounds = 5, frames = 8;
};

passes::Sequence play(scene::Scene& scene)
{
    return {scene, {.animations = {0}}, 0};
}

// Milliseconds to pose the scene and to hand it over, outside of all rays.
void hostTime(gpu::Device& device, const char* what, scene::Scene scene, const Options& options)
{
    passes::Settings settings;
    settings.width = settings.height = 16;
    passes::Renderer renderer(device, scene, settings, {.moves = true});
    const passes::Sequence sequence = play(scene);
    std::vector<double> times;
    for (uint32_t frame = 1; frame <= options.rounds * options.frames; ++frame) {
        const auto start = Clock::now();
        sequence.bring(renderer, frame);
        renderer.wait(); // (nothing is in flight)
        times.push_back(1000 * secondsSince(start));
        renderer.renderFrame();
        renderer.wait();
    }
    fmt::print("{}: {} triangles, {:.2f} ms a frame on the host (median of {})\n", what, scene.triangles.size(),
               median(times), times.size());
}

double millisecondsOf(const passes::RenderStats& stats) // of a frame
{
    double sum = 0;
    for (const auto& [stage, milliseconds] : stats.stageMilliseconds) sum += milliseconds;
    return sum;
}

passes::Settings settingsOf(passes::Method method, const Options& options)
{
    passes::Settings settings;
    const size_t times = options.size.find('x');
    settings.width = uint32_t(std::stoul(options.size));
    settings.height = uint32_t(std::stoul(options.size.substr(times + 1)));
    settings.method = method;
    settings.average = false;
    return settings;
}

// The hall as it is, and with all but its lamps stored once, in one place.
void twoLevels(gpu::Device& device, const Options& options)
{
    const passes::Settings settings = settingsOf(passes::Method::Pt, options);
    const scene::Scene flat = scene::makeHall();
    scene::Scene stored = flat;
    const auto shines = [&](const scene::Triangle& t) { return flat.materials[t.material].emission != glm::vec3(0); };
    std::erase_if(stored.triangles, [&](const scene::Triangle& t) { return !shines(t); });
    stored.meshes.emplace_back(flat);
    std::erase_if(stored.meshes[0].triangles, shines);
    stored.instances.push_back({});
    passes::Renderer one(device, flat, settings), two(device, stored, settings);
    std::vector<double> ratios;
    for (uint32_t round = 0; round <= options.rounds; ++round) {
        std::vector<double> raysPerMillisecond;
        for (passes::Renderer* renderer : {&one, &two}) {
            renderer->reset();
            for (uint32_t frame = 0; frame < options.frames; ++frame) renderer->renderFrame();
            const passes::RenderStats stats = renderer->stats();
            raysPerMillisecond.push_back(double(passes::sumOf(stats.rays)) / millisecondsOf(stats));
        }
        if (round > 0) ratios.push_back(raysPerMillisecond[1] / raysPerMillisecond[0]); // warm by then
    }
    fmt::print("hall through two levels: {:.2f} of the rays a second through one (median of {} rounds)\n",
               median(ratios), ratios.size());
}

void frameTime(gpu::Device& device, passes::Method method, const char* name, bool storedOnce, const Options& options)
{
    const passes::Settings settings = settingsOf(method, options);
    scene::Scene scene = hallWithBodies(storedOnce);
    const passes::Sequence moves = play(scene);
    const passes::Sequence orbit = passes::cameraOrbit(scene.cameras[0], 0.3), rests;
    struct Case {
        const char* name;
        const passes::Sequence* sequence;
        std::unique_ptr<passes::Renderer> renderer;
        std::vector<double> milliseconds;
        std::map<std::string, std::vector<double>> ofStages;
    };
    std::vector<Case> cases;
    for (const auto& [what, sequence] :
         {std::pair("at rest", &rests), {"camera moves", &orbit}, {"bodies move", &moves}})
        cases.push_back({what,
                         sequence,
                         std::make_unique<passes::Renderer>(device, scene, settings,
                                                            passes::SceneOptions{.moves = sequence->sceneMoves()}),
                         {},
                         {}});
    for (uint32_t round = 0; round <= options.rounds; ++round) {
        for (Case& c : cases) {
            c.sequence->bring(*c.renderer, 0);
            c.renderer->reset();
            for (uint32_t frame = 0; frame < options.frames; ++frame) {
                c.sequence->bring(*c.renderer, frame);
                c.renderer->renderFrame();
            }
            if (round == 0) continue; // warm by then
            const passes::RenderStats stats = c.renderer->stats();
            c.milliseconds.push_back(millisecondsOf(stats));
            for (const auto& [stage, milliseconds] : stats.stageMilliseconds) c.ofStages[stage].push_back(milliseconds);
        }
    }
    for (const Case& c : cases) {
        std::vector<double> ratios;
        for (size_t i = 0; i < c.milliseconds.size(); ++i)
            ratios.push_back(c.milliseconds[i] / cases[0].milliseconds[i]);
        fmt::print("{} hybrid, {}: {:.1f} ms a frame, {:.2f} of the one at rest (medians of {} rounds)\n", name, c.name,
                   median(c.milliseconds), median(ratios), ratios.size());
        for (const auto& [stage, milliseconds] : c.ofStages)
            fmt::print("    {}: {:.1f}\n", stage, median(milliseconds));
    }
}

int bench(const Options& options)
{
    gpu::Device device = gpu::Device::create({.adapter = options.device});
    hostTime(device, "a hundred bodies in hall", hallWithBodies(false), options);
    hostTime(device, "a hundred bodies in hall, stored once", hallWithBodies(true), options);
    hostTime(device, "a skinned mesh of 10^5 triangles in hall", skinnedBanner(), options);
    twoLevels(device, options);
    frameTime(device, passes::Method::RestirPt, "restir-pt", false, options);
    frameTime(device, passes::Method::RestirPt, "restir-pt, stored once,", true, options);
    frameTime(device, passes::Method::RgbRestir, "rgb-restir", false, options);
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App app("What it costs that a scene moves.");
    app.add_option("--device", options.device, "Index, or part of its name.");
    app.add_option("--size", options.size, "Of the frames.");
    app.add_option("--rounds", options.rounds, "Of which medians are taken.");
    app.add_option("--frames", options.frames, "Of a round.");
    CLI11_PARSE(app, argc, argv);
    try {
        return bench(options);
    } catch (const Error& error) {
        fmt::print(stderr, "motion_bench: {}\n", error.what());
        return 1;
    }
}
