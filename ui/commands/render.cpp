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
#include "ui/cli/ranks.h"
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
#include <numeric>

#include <fmt/format.h>

namespace ui
{

namespace
{

// What a picture of this process counts in that of all, by what it shows.
struct Share {
    double ofMean = 1, ofLast = 1; // alone
};

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
    void requireShareable(const passes::Settings& wanted) const;
    Share renderFrames(passes::Renderer& renderer, const passes::Sequence& sequence, Progress& progress,
                       RunReport& report, Clock::time_point commandStart);
    Share addUp(passes::Renderer& renderer, RunReport& report) const;
    image::Image read(passes::Renderer& renderer, const passes::Output& which, const Share& share) const;
    void writePicture(const std::filesystem::path& file, passes::Renderer& renderer, RunReport& report,
                      const Share& share = {}) const;
};

// What several processes can do together.
void RenderCommand::requireShareable(const passes::Settings& wanted) const
{
    if (ranks().count() == 1) return;
    if (checkpoint.given())
        throw UsageError("--checkpoint and --resume are for one process, and this is one of {}: leave them out.",
                         ranks().count());
    if (!frames.given() && !wanted.average)
        throw UsageError("{} processes cannot share one frame, the last of --frames: only the mean of all of them "
                         "(--average on), or a --sequence.",
                         ranks().count());
    if (frames.chains().length > 1 && !frames.restarts())
        throw UsageError(
            "{} processes cannot share frames that depend on all before them, as those of {} do: --restart "
            "N forgets history after every N frames.",
            ranks().count(), passes::WORDS_OF<passes::Method>[size_t(wanted.method)]);
}

// Until the settings say stop, or Ctrl-C or SIGTERM does. Of several processes each renders its chains.
Share RenderCommand::renderFrames(passes::Renderer& renderer, const passes::Sequence& sequence, Progress& progress,
                                  RunReport& report, Clock::time_point commandStart)
{
    const passes::Settings& wanted = report.settings;
    const bool byTime = wanted.seconds > 0;
    const FrameChains& chains = frames.chains();
    const Interrupt interrupt;
    const auto bring = [&](uint64_t place) { sequence.bring(renderer, chains.at(place).number); };
    const double before = checkpoint.start(renderer, report, bring);
    const auto start = Clock::now();
    double elapsed = before;
    const auto next = [&] { return chains.turn(report.frames, ranks().index(), ranks().count()); };
    const auto finished = [&] { return byTime ? elapsed >= wanted.seconds : next() >= chains.places(); };
    report.frames = renderer.frameCount(); // up to and with the last one's place
    while (!(finished() || (report.frames > 0 && interrupt.requested()))) {
        const uint64_t place = next();
        bring(place);
        renderer.setFrame(uint32_t(chains.at(place).number));
        if (chains.at(place).begins) renderer.forgetHistory();
        renderer.renderFrame();
        report.frames = place + 1;
        if (report.firstPixelSeconds == 0) {
            renderer.wait();
            report.firstPixelSeconds = secondsSince(commandStart);
        }
        const std::filesystem::path file = frames.fileOf(place);
        if (!file.empty()) writePicture(file, renderer, report);
        elapsed = before + secondsSince(start);
        checkpoint.keep(renderer, elapsed);
        if (byTime)
            progress.show("Rendering", elapsed, wanted.seconds);
        else
            progress.show("Rendering", double(report.frames), wanted.frames, "frames");
    }
    renderer.wait();
    report.partial = !finished();
    const Share share = addUp(renderer, report);
    report.wallSeconds = before + secondsSince(start);
    progress.clear();
    return share;
}

// What is reported of one process becomes what is reported of all. Times and memory stay those of each.
Share RenderCommand::addUp(passes::Renderer& renderer, RunReport& report) const
{
    report.stats = renderer.stats();
    report.processes = ranks().count();
    const auto own = ptrdiff_t(ranks().index());
    std::vector<double> done(report.processes, 0), ends = done;
    done[size_t(own)] = double(renderer.frameCount());
    ends[size_t(own)] = double(report.frames);
    ranks().sum(done);
    ranks().sum(ends);
    const double all = std::reduce(done.begin(), done.end());
    const Share share = {.ofMean = double(renderer.frameCount()) / all,
                         .ofLast = std::ranges::max_element(ends) - ends.begin() == own ? 1.0 : 0.0};

    std::vector<double> counts = {report.partial ? 1.0 : 0.0};
    for (int c = 0; c < 3; ++c) counts.push_back(share.ofLast * report.meanRgb[c]); // of the last file of a sequence
    const auto kinds = {&report.stats.rays, &report.stats.shifts, &report.stats.nonFinite};
    for (const auto* kind : kinds)
        for (const auto& [name, count] : *kind) counts.push_back(double(count));
    ranks().sum(counts);
    report.frames = uint64_t(all);
    report.partial = counts[0] > 0;
    report.meanRgb = {counts[1], counts[2], counts[3]};
    size_t i = 4;
    for (auto* kind : kinds)
        for (auto& [name, count] : *kind) count = uint64_t(counts[i++]);
    return share;
}

// A frame of a sequence is its process's own; a still is one picture of all.
image::Image RenderCommand::read(passes::Renderer& renderer, const passes::Output& which, const Share& share) const
{
    image::Image picture = renderer.read(which);
    if (frames.given() || ranks().count() == 1) return picture;
    const double weight = which.sums ? share.ofMean : share.ofLast;
    std::vector<double> values;
    values.reserve(3 * picture.pixels.size());
    for (const glm::vec3& pixel : picture.pixels)
        for (int c = 0; c < 3; ++c) values.push_back(weight * double(pixel[c]));
    ranks().sum(values);
    for (size_t i = 0; i < values.size(); ++i) picture.pixels[i / 3][int(i % 3)] = float(values[i]);
    return picture;
}

void RenderCommand::writePicture(const std::filesystem::path& file, passes::Renderer& renderer, RunReport& report,
                                 const Share& share) const
{
    const image::Image picture = read(renderer, passes::colorOf(renderer.settings()), share);
    report.meanRgb = meanOf(picture);
    std::vector<image::Layer> more;
    for (const passes::Output* one : passes::OUTPUTS)
        if (std::ranges::find(layers, one->name) != layers.end())
            more.push_back({one->name, one->channels, read(renderer, *one, share)});
    if (frames.given() || ranks().index() == 0) image::write(file, picture, metadataOf(report), more);
}

int RenderCommand::run()
{
    const auto commandStart = Clock::now();
    RunReport report{.scene = scene.name, .settings = settings.read()};
    motion.adjust(report.settings, settings, scene);
    frames.adjust(report.settings, settings, output);
    requireShareable(report.settings);
    report.extra = motionText(scene, motion);
    std::ranges::move(frames.toText(), std::back_inserter(report.extra));
    const std::string lastFile = frames.given() ? frames.fileOf(frames.chains().places() - 1).string() : output;
    NamedFiles named;
    named.writes("--output", lastFile);
    named.writes("--stats", stats);
    checkpoint.name(named);
    motion.name(named);
    settings.name(named, report.settings);
    named.reads("SCENE", scene.name);
    requireWritable(lastFile, {".exr", ".png"});
    if (!layers.empty() && files::extensionOf(output) != ".exr")
        throw UsageError("--layers needs an EXR: \"{}\" holds one picture only.", output);
    const bool mean = std::ranges::find(layers, passes::MEAN.name) != layers.end();
    if (mean && frames.given())
        throw UsageError("--layers mean cannot be combined with --sequence: each file is one frame.");
    if (mean && motion.moving() && !report.settings.average)
        throw UsageError("--layers mean cannot be combined with a moving camera or scene: the mean of frames that show "
                         "different things is no picture.");
    if (!stats.empty()) requireWritable(stats);
    checkpoint.requireWritable();

    const bool first = ranks().index() == 0;
    Progress progress(quiet || !first);
    const auto loadStart = Clock::now();
    gpu::Device gpu = device.open(checkpoint.resumes());
    scene::Scene world = first ? openScene(scene, report.settings, progress)
                               : openScene(scene, report.settings, LoadProgress()); // without its warnings
    for (const std::filesystem::path& file : world.files) named.reads("SCENE", file);
    for (uint64_t place = 0; frames.given() && place < frames.chains().places(); ++place)
        if (const auto file = frames.fileOf(place); !file.empty()) named.writesAlso("--output", file);
    const passes::Sequence sequence = motion.read(world, report.settings, scene);
    report.adapter = gpu.adapter();
    report.loadSeconds = secondsSince(loadStart);
    passes::Renderer renderer(gpu, world, report.settings,
                              {.bvhProgress = [&](double fraction) { progress.show("Building the BVH", fraction, 1); },
                               .moves = sequence.sceneMoves()});

    if (const int failed = ranks().meet(); failed != 0) return failed;
    const Share share = renderFrames(renderer, sequence, progress, report, commandStart);
    const bool kept = checkpoint.finish(renderer, report.wallSeconds);
    if (!frames.given()) writePicture(output, renderer, report, share);
    if (!first) return report.partial ? Interrupt::exitCode() : 0;
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
