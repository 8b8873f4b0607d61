// converge SCENE -o DIR: error against run time for several methods, as CSV, SVG and one page.

#include "engine/base/clock.h"
#include "engine/base/files.h"
#include "engine/base/fingerprint.h"
#include "passes/experiments/race.h"
#include "passes/experiments/race_store.h"
#include "passes/experiments/reference.h"
#include "ui/cli/device_options.h"
#include "ui/cli/interrupt.h"
#include "ui/cli/method_list.h"
#include "ui/cli/motion_options.h"
#include "ui/cli/number_range.h"
#include "ui/cli/output_file.h"
#include "ui/cli/progress.h"
#include "ui/cli/run_report.h"
#include "ui/cli/scene_source.h"
#include "ui/cli/settings_options.h"
#include "ui/cli/usage_error.h"
#include "ui/commands/commands.h"
#include "ui/report/converge_page.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <memory>

namespace ui
{

namespace
{

constexpr double DEFAULT_SECONDS = 10;
constexpr uint64_t MIN_REFERENCE_FRAMES = 16, MAX_REFERENCE_FRAMES = 1 << 30;
constexpr double REPORT_SECONDS = 120; // a kill leaves a report at most so old

struct ConvergeCommand {
    SceneSource scene;
    std::string directory, methods, reference = "auto";
    size_t runs = 8;
    passes::Precision precision;
    bool resume = false, quiet = false;
    DeviceOptions device;
    MotionOptions motion;
    SettingsOptions settings;

    int run();

    passes::Race::Limits limitsOf(const passes::Settings& wanted) const;
    std::string keyOf(const ConvergeReport& report, const passes::Race::Limits& limits) const;
    void write(ConvergeReport& report, const passes::RaceStore& store, const passes::References& references) const;
};

template <class Value>
std::vector<Value> each(const std::vector<passes::NamedMethod>& methods, Value passes::NamedMethod::*value)
{
    std::vector<Value> values;
    for (const passes::NamedMethod& method : methods) values.push_back(method.*value);
    return values;
}

// The path tracer, first in the list when it is not there.
uint32_t ensurePathTracer(std::vector<passes::NamedMethod>& methods, const passes::Settings& base)
{
    const auto isPt = [](const passes::NamedMethod& method) { return method.settings.method == passes::Method::Pt; };
    if (std::ranges::none_of(methods, isPt)) methods.insert(methods.begin(), readMethods("pt", base).front());
    return uint32_t(std::ranges::find_if(methods, isPt) - methods.begin());
}

// Size and time of a file's last change; empty for what is none.
std::string stampOf(const std::filesystem::path& file)
{
    std::error_code none;
    if (!std::filesystem::is_regular_file(file, none)) return "";
    return fmt::format("{} {}", std::filesystem::file_size(file, none),
                       std::filesystem::last_write_time(file, none).time_since_epoch().count());
}

passes::Race::Limits ConvergeCommand::limitsOf(const passes::Settings& wanted) const
{
    if (motion.moving() && wanted.seconds > 0)
        throw UsageError("--seconds cannot be combined with a moving camera: each frame that is measured needs a "
                         "reference of its own. Use --frames.");
    if (wanted.seconds > 0) return {.seconds = wanted.seconds};
    const bool byFrames = motion.moving() || settings.given("frames") || wanted.frames != passes::Settings().frames;
    return byFrames ? passes::Race::Limits{.frames = wanted.frames} : passes::Race::Limits{.seconds = DEFAULT_SECONDS};
}

// Of everything that decides the figures, but for the number of repeats.
std::string ConvergeCommand::keyOf(const ConvergeReport& report, const passes::Race::Limits& limits) const
{
    std::vector<std::string> facts = {scene.name,
                                      stampOf(scene.name),
                                      reference,
                                      stampOf(reference),
                                      report.provenance.device,
                                      report.provenance.driver,
                                      version(),
                                      fmt::format("{} {}", precision.error, precision.maxFrames),
                                      fmt::format("{} {}", limits.frames, limits.seconds)};
    for (const auto& [name, value] : scene.toText()) facts.insert(facts.end(), {name, value});
    for (const auto& [name, value] : motion.toText()) facts.insert(facts.end(), {name, value, stampOf(value)});
    for (const passes::NamedMethod& method : report.methods) facts.push_back(method.name + " " + hash(method.settings));
    uint64_t state = 0;
    for (const std::string& fact : facts) state = fingerprint(std::string_view(fact), state);
    return fmt::format("{:016x}", state);
}

void ConvergeCommand::write(ConvergeReport& report, const passes::RaceStore& store,
                            const passes::References& references) const
{
    report.references = references.made();
    report.pictures.clear();
    for (size_t method = 0; method < report.methods.size() && std::filesystem::exists(store.picture(method)); ++method)
        report.pictures.push_back(image::read(store.picture(method)).image);

    const std::filesystem::path folder = directory;
    const std::vector<NamedPlot> plots = convergePlots(report);
    for (const NamedPlot& plot : plots) writeText(folder / plot.file, plot.svg);
    writeText(folder / "converge.csv", convergeCsv(report));
    for (const auto& [frames, made] : report.references) {
        image::Metadata metadata = motionText(scene, motion);
        metadata.insert(metadata.end(), {{"scene", scene.name}, {"frames-done", std::to_string(made.pathTraced)}});
        image::write(folder / (report.moving ? fmt::format("reference-{}.exr", frames) : "reference.exr"), made.picture,
                     metadata);
    }
    writeText(folder / "index.html", convergePage(report, plots));
}

// Before anything is measured. Where something moves, each measured frame has a reference of its own: once it is known
// how long one takes, it is said what all will take, if that is worth a word.
void traceReferences(passes::References& references, bool moving, uint64_t frames, Progress& progress,
                     const std::function<bool()>& stop)
{
    constexpr double WORTH_A_WORD = 60; // s
    const auto start = Clock::now();
    const passes::Reference* first = references.after(frames);
    if (!moving || !first) return;
    std::vector<uint64_t> others;
    for (uint64_t frame = 1; frame < frames; ++frame)
        if (passes::isCheckpoint(frame, true)) others.push_back(frame);
    const double each = secondsSince(start), left = each * double(others.size());
    if (!first->fromCache && left > WORTH_A_WORD) {
        progress.clear();
        fmt::print(
            stderr,
            "Path tracing {} more references, one for each frame that is measured: about {:.0f} minutes, since the "
            "first took {:.0f} s. --reference-error, now {}, says how precise they must be.\n",
            others.size(), std::ceil(left / 60), each, references.precision().error);
    }
    for (const uint64_t frame : others)
        if (!stop()) references.after(frame);
}

int ConvergeCommand::run()
{
    passes::Settings wanted = settings.read();
    motion.adjust(wanted, settings, scene);
    ConvergeReport report{.scene = scene.name, .methods = readMethods(methods, wanted), .moving = motion.moving()};
    report.pt = ensurePathTracer(report.methods, wanted);
    report.precision = precision.error;
    const passes::Race::Limits limits = limitsOf(wanted);
    if (reference != "auto") {
        if (report.moving)
            throw UsageError("--reference FILE cannot be combined with a moving camera or scene: use auto.");
        report.referenceFile = reference;
    }
    NamedFiles named;
    for (const char* file : {"index.html", "converge.csv", "reference.exr"})
        named.writes("--output", std::filesystem::path(directory) / file);
    if (reference != "auto") named.reads("--reference", reference);
    motion.name(named);
    settings.name(named, wanted);
    named.reads("SCENE", scene.name);
    files::createFolder(directory);
    requireWritable(std::filesystem::path(directory) / "index.html");

    Progress progress(quiet);
    gpu::Device gpu = device.open();
    scene::Scene world = openScene(scene, wanted, progress);
    const passes::Sequence sequence = motion.read(world, wanted, scene);
    report.provenance = {.command = commandLine(),
                         .scene = scene.name,
                         .device = gpu.adapter().name,
                         .driver = gpu.adapter().driver,
                         .settings = passes::toText(wanted)};
    std::ranges::move(motionText(scene, motion), std::back_inserter(report.provenance.settings));
    for (const passes::NamedMethod& method : report.methods)
        report.provenance.settings.emplace_back("settings hash of " + method.name, hash(method.settings));

    const passes::RaceStore store(directory, keyOf(report, limits), each(report.methods, &passes::NamedMethod::name));
    if (resume)
        report.repeats = store.read(runs);
    else
        store.requireNew();

    passes::Race race(gpu, world, each(report.methods, &passes::NamedMethod::settings), sequence, limits,
                      [&](double fraction) { progress.show("Building the BVH", fraction, 1); });
    const Interrupt interrupt;
    const auto stop = [&] { return interrupt.requested(); };
    passes::References references =
        report.referenceFile.empty()
            ? passes::References(race.renderer(), wanted, sequence,
                                 {.precision = precision,
                                  .cache = cacheDirectory().empty() ? "" : cacheDirectory() + "/references",
                                  .progress = [&](double done) { progress.show("Path tracing a reference", done, 1); },
                                  .stop = stop})
            : passes::References(reference, wanted);
    for (const std::string& warning : references.warnings()) fmt::print(stderr, "Warning: {}\n", warning);

    auto written = Clock::now();
    traceReferences(references, report.moving, limits.frames, progress, stop);
    while (report.repeats.size() < runs && !stop()) {
        const size_t index = report.repeats.size();
        passes::Repeat repeat = race.run(
            wanted.seed + index, references,
            [&](double done) { progress.show("Measuring", double(index) + done, double(runs), "repeats"); }, stop);
        if (repeat.complete) store.write(index, repeat);
        report.repeats.push_back(std::move(repeat));
        if (report.repeats.size() == runs || secondsSince(written) < REPORT_SECONDS) continue;
        report.provenance.partial = true;
        write(report, store, references);
        written = Clock::now();
    }
    progress.clear();
    const auto complete = size_t(std::ranges::count_if(report.repeats, &passes::Repeat::complete));
    report.provenance.partial = complete < runs;
    write(report, store, references);
    for (const std::string& sentence : convergeVerdicts(report)) fmt::print("{}\n", sentence);
    fmt::print("{}/index.html\n", directory);

    uint64_t nonFinite = 0;
    for (const passes::Repeat& repeat : report.repeats) nonFinite += repeat.nonFinite;
    if (nonFinite > 0) fmt::print(stderr, "Warning: {} values were not finite and counted as 0.\n", nonFinite);
    if (!report.provenance.partial) return 0;
    fmt::print(stderr,
               "Interrupted: the report in \"{}\" is partial, marked so, with {} of {} repeats; --resume goes on.\n",
               directory, complete, runs);
    return Interrupt::exitCode();
}

} // namespace

Action setUpConverge(CLI::App& app)
{
    const auto command = std::make_shared<ConvergeCommand>();
    addSceneOptions(app, command->scene, SCENE_DOC)->required();
    app.add_option(
           "-o,--output", command->directory,
           "Where the report goes, made when missing: index.html (one self-contained page), converge.csv, plots "
           "as SVG, pictures as EXR.")
        ->option_text("DIR")
        ->required();
    addMethodsOption(app, command->methods, "pt,restir-pt,rgb-restir");
    app.add_option(
           "--runs", command->runs,
           "Repeats, each with seeds of its own; intervals come from them. Methods take turns within each. Each "
           "runs for --seconds (10 s of each method unless --frames says otherwise), or with a moving camera for "
           "--frames. Means and single frames are both measured, whatever --average says.")
        ->option_text("whole number, 1 to 9999 (8)")
        ->check(within(1, 9999));
    app.add_option(
           "--reference", command->reference,
           "What errors are measured against. auto: path traced with other random numbers, its own error estimated "
           "and subtracted, kept in $XDG_CACHE_HOME/trichrome/references; with a moving camera one for each "
           "measured frame.")
        ->option_text("FILE|auto (auto)");
    app.add_option("--reference-error", command->precision.error,
                   "How precise an automatic reference has to be: the root of its own relative MSE.")
        ->option_text("0.0001 to 1 (0.02)")
        ->check(within(1e-4, 1.0));
    app.add_option("--reference-frames", command->precision.maxFrames,
                   "And the most frames it may take; the page says so.")
        ->option_text("frames, 16 to 1073741824 (16384)")
        ->check(within(MIN_REFERENCE_FRAMES, MAX_REFERENCE_FRAMES));
    app.add_flag(
        "--resume", command->resume,
        "Goes on where a killed or interrupted run of the same settings stopped: finished repeats in DIR count.");
    app.add_flag("--quiet", command->quiet, "No progress on the terminal.");
    command->device.addTo(app);
    command->motion.addTo(app);
    command->settings.addTo(app);
    return [command] { return command->run(); };
}

} // namespace ui
