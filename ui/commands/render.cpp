// render SCENE -o FILE: frames of one scene into one picture.

#include "engine/base/clock.h"
#include "engine/base/files.h"
#include "engine/base/json.h"
#include "passes/renderer.h"
#include "ui/cli/checkpoint_options.h"
#include "ui/cli/device_options.h"
#include "ui/cli/interrupt.h"
#include "ui/cli/motion_options.h"
#include "ui/cli/output_file.h"
#include "ui/cli/progress.h"
#include "ui/cli/run_report.h"
#include "ui/cli/scene_source.h"
#include "ui/cli/sequence_output.h"
#include "ui/cli/settings_options.h"
#include "ui/cli/usage_error.h"
#include "ui/commands/commands.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <memory>

#include <fmt/format.h>

namespace ui
{

namespace
{

struct RenderCommand {
    SceneSource scene;
    std::string output, stats;
    std::vector<std::string> layers;
    bool quiet = false;
    DeviceOptions device;
    MotionOptions motion;
    SequenceOutput frames;
    CheckpointOptions checkpoint;
    SettingsOptions settings;

    int run();
    void renderFrames(passes::Renderer& renderer, const passes::Sequence& sequence, Progress& progress,
                      RunReport& report, Clock::time_point commandStart);
    void writePicture(const std::filesystem::path& file, passes::Renderer& renderer, RunReport& report) const;
};

// Until the settings say stop, or Ctrl-C or SIGTERM does.
void RenderCommand::renderFrames(passes::Renderer& renderer, const passes::Sequence& sequence, Progress& progress,
                                 RunReport& report, Clock::time_point commandStart)
{
    const passes::Settings& wanted = report.settings;
    const bool byTime = wanted.seconds > 0;
    const Interrupt interrupt;
    const auto bring = [&](uint64_t rendered) { sequence.bring(renderer, frames.numberOf(rendered)); };
    const double before = checkpoint.start(renderer, report, bring);
    const auto start = Clock::now();
    double elapsed = before;
    report.frames = renderer.frameCount();
    const auto finished = [&] { return byTime ? elapsed >= wanted.seconds : report.frames >= wanted.frames; };
    while (report.frames == 0 || !(finished() || interrupt.requested())) {
        bring(report.frames);
        renderer.renderFrame();
        report.frames = renderer.frameCount();
        if (report.firstPixelSeconds == 0) {
            renderer.wait();
            report.firstPixelSeconds = secondsSince(commandStart);
        }
        const std::filesystem::path file = frames.fileOf(report.frames - 1);
        if (!file.empty()) writePicture(file, renderer, report);
        elapsed = before + secondsSince(start);
        checkpoint.keep(renderer, elapsed);
        if (byTime)
            progress.show("Rendering", elapsed, wanted.seconds);
        else
            progress.show("Rendering", double(report.frames), wanted.frames, "frames");
    }
    renderer.wait();
    report.wallSeconds = before + secondsSince(start);
    report.partial = !finished();
    progress.clear();
}

void RenderCommand::writePicture(const std::filesystem::path& file, passes::Renderer& renderer, RunReport& report) const
{
    const image::Image picture = renderer.read(passes::colorOf(renderer.settings()));
    report.stats = renderer.stats();
    report.meanRgb = meanOf(picture);
    std::vector<image::Layer> more;
    for (const passes::Output* one : passes::OUTPUTS)
        if (std::ranges::find(layers, one->name) != layers.end())
            more.push_back({one->name, one->channels, renderer.read(*one)});
    image::write(file, picture, metadataOf(report), more);
}

int RenderCommand::run()
{
    const auto commandStart = Clock::now();
    RunReport report{.scene = scene.name, .settings = settings.read()};
    motion.adjust(report.settings, settings, scene);
    frames.adjust(report.settings, settings, output);
    report.extra = motionText(scene, motion);
    std::ranges::move(frames.toText(), std::back_inserter(report.extra));
    NamedFiles named;
    named.writes("--output", frames.given() ? frames.fileOf(report.settings.frames - 1).string() : output);
    named.writes("--stats", stats);
    checkpoint.name(named);
    motion.name(named);
    settings.name(named, report.settings);
    named.reads("SCENE", scene.name);
    requireWritable(frames.given() ? frames.fileOf(report.settings.frames - 1).string() : output, {".exr", ".png"});
    if (!layers.empty() && files::extensionOf(output) != ".exr")
        throw UsageError("--layers needs an EXR: \"{}\" holds one picture only.", output);
    const bool mean = std::ranges::find(layers, passes::MEAN.name) != layers.end();
    if (mean && motion.moving() && !report.settings.average)
        throw UsageError("--layers mean cannot be combined with a moving camera or scene: the mean of frames that show "
                         "different things is no picture.");
    if (!stats.empty()) requireWritable(stats);
    checkpoint.requireWritable();

    Progress progress(quiet);
    const auto loadStart = Clock::now();
    gpu::Device gpu = device.open(checkpoint.resumes());
    scene::Scene world = openScene(scene, report.settings, progress);
    for (const std::filesystem::path& file : world.files) named.reads("SCENE", file);
    for (uint64_t frame = 0; frames.given() && frame < report.settings.frames; ++frame)
        if (const auto file = frames.fileOf(frame); !file.empty()) named.writesAlso("--output", file);
    const passes::Sequence sequence = motion.read(world, report.settings, scene);
    report.adapter = gpu.adapter();
    report.loadSeconds = secondsSince(loadStart);
    passes::Renderer renderer(
        gpu, world, report.settings, [&](double fraction) { progress.show("Building the BVH", fraction, 1); },
        scene::FeatureSet::Needed, 1, nullptr, sequence.sceneMoves());

    renderFrames(renderer, sequence, progress, report, commandStart);
    const bool kept = checkpoint.finish(renderer, report.wallSeconds);
    if (!frames.given()) writePicture(output, renderer, report);
    if (!stats.empty()) writeText(stats, jsonText(toJson(report), 2) + "\n");

    for (const auto& [stage, count] : report.stats.nonFinite)
        if (count > 0)
            fmt::print(stderr, "Warning: stage {} found {} values that are not finite and counted them as 0.\n", stage,
                       count);
    if (!report.partial) return kept ? 0 : 1;
    if (frames.given())
        fmt::print(stderr, "Interrupted after {} of {} frames; those that are written are whole.\n", report.frames,
                   report.settings.frames);
    else
        fmt::print(stderr, "Interrupted: {} is partial, marked so, with {} frames.\n", output, report.frames);
    return Interrupt::exitCode();
}

} // namespace

Action setUpRender(CLI::App& app)
{
    const auto command = std::make_shared<RenderCommand>();
    addSceneOptions(app, command->scene, SCENE_DOC)->required();
    app.add_option("-o,--output", command->output,
                   "The picture. EXR: float32 linear RGB. PNG: c/(c+1), then sRGB. Both with all settings inside.")
        ->option_text("FILE.exr|FILE.png")
        ->required();
    std::vector<std::string> names;
    std::string meanings;
    for (const passes::Output* one : passes::OUTPUTS) {
        names.emplace_back(one->name);
        meanings += fmt::format("{}{}: {}", meanings.empty() ? "" : "; ", one->name, one->doc);
    }
    app.add_option("--layers", command->layers,
                   "Pictures that the EXR holds besides the one that every program shows, as layers of these names. " +
                       meanings + ". compare takes a layer as FILE.exr:NAME.")
        ->option_text("NAME,...")
        ->delimiter(',')
        ->check([names](const std::string& name) {
            if (std::ranges::find(names, name) != names.end()) return std::string();
            return fmt::format("\"{}\" is no layer; there are: {}.", name, fmt::join(names, ", "));
        });
    app.add_option("--stats", command->stats, "Writes what was done, for programs: times, rays, memory, settings.")
        ->option_text("FILE.json");
    app.add_flag("--quiet", command->quiet, "No progress on the terminal.");
    command->device.addTo(app);
    command->motion.addTo(app);
    command->frames.addTo(app);
    command->checkpoint.addTo(app);
    command->settings.addTo(app);
    return [command] { return command->run(); };
}

} // namespace ui
