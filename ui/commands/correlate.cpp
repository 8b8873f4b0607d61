// correlate SCENE -o DIR: the paper's experiment, how strongly frames of temporal reuse depend on each other.

#include "engine/base/clock.h"
#include "passes/experiments/correlation_store.h"
#include "passes/experiments/correlator.h"
#include "ui/cli/device_options.h"
#include "ui/cli/interrupt.h"
#include "ui/cli/method_list.h"
#include "ui/cli/motion_options.h"
#include "ui/cli/number_range.h"
#include "ui/cli/progress.h"
#include "ui/cli/ranks.h"
#include "ui/cli/run_report.h"
#include "ui/cli/scene_source.h"
#include "ui/cli/settings_options.h"
#include "ui/cli/usage_error.h"
#include "ui/commands/commands.h"
#include "ui/report/correlation_page.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <memory>

namespace ui
{

namespace
{

constexpr uint32_t MIN_BATCH = 3; // runs: below, nothing is left to leave out

// The paper's protocol.
passes::Settings protocol()
{
    passes::Settings settings;
    settings.method = passes::Method::RgbRestir; // --methods decides
    settings.shift = passes::Shift::Replay;
    settings.spatial = 0;
    settings.color = passes::Color::Chosen;
    settings.maxConfidence = 1024;
    settings.width = 64;
    settings.height = 36;
    settings.frames = 1u << 20; // --max-confidence decides
    settings.average = false;
    return settings;
}

struct CorrelateCommand {
    SceneSource scene;
    std::string output, methods;
    uint32_t runs = 32, batch = 16;
    bool resume = false, quiet = false;
    DeviceOptions device;
    MotionOptions motion;
    SettingsOptions settings{protocol()};

    passes::Settings readSettings();
    std::vector<passes::NamedMethod> readMethods(const passes::Settings& base) const;
    std::vector<uint32_t> shareOut(const gpu::Device& gpu, const std::vector<passes::NamedMethod>& list) const;
    int run();
};

passes::Settings CorrelateCommand::readSettings()
{
    if (settings.given("method")) throw UsageError("correlate takes --methods, a list, instead of --method.");
    passes::Settings base = settings.read();
    if (base.pixelFilter != passes::PixelFilter::Center)
        throw UsageError("correlate follows what a pixel's center sees; --pixel-filter must be center, not box.");
    return base;
}

std::vector<passes::NamedMethod> CorrelateCommand::readMethods(const passes::Settings& base) const
{
    std::vector<passes::NamedMethod> list = ui::readMethods(methods, base);
    const auto isPlain = [](const passes::NamedMethod& method) { return method.settings.method == passes::Method::Pt; };
    if (methods == "all") std::erase_if(list, isPlain);
    for (const passes::NamedMethod& method : list) {
        if (isPlain(method))
            throw UsageError("--methods: \"{}\" has no history; its frames do not depend on each other.", method.name);
        if (passes::lastFrame(method.settings) < 2)
            throw UsageError("--methods: \"{}\" renders {} frame; --frames and --max-confidence must be at least 2.",
                             method.name, passes::lastFrame(method.settings));
    }
    return list;
}

// Runs of each batch: --batch or what the device can bind, and what is left in the last. The same on all ranks, however
// many there are; and with more --runs the full batches stay what they were.
std::vector<uint32_t> CorrelateCommand::shareOut(const gpu::Device& gpu,
                                                 const std::vector<passes::NamedMethod>& list) const
{
    uint32_t most = batch;
    for (const passes::NamedMethod& method : list)
        most = std::min(most, passes::maxRuns(gpu.limits(), method.settings));
    std::vector<uint32_t> sizes;
    for (uint32_t left = runs; most >= MIN_BATCH && left > 0; left -= sizes.back())
        sizes.push_back(std::min(left, most));
    for (size_t i = sizes.size(); i-- > 1 && sizes.back() < MIN_BATCH;) { // too few: those before give some
        const uint32_t given = std::min(sizes[i - 1] - MIN_BATCH, MIN_BATCH - sizes.back());
        sizes[i - 1] -= given;
        sizes.back() += given;
    }
    if (sizes.empty() || sizes.back() < MIN_BATCH)
        throw Error(
            "{} runs of {}x{} pixels do not make batches of {} or more, of which the device \"{}\" can render {} "
            "at once; reduce --size.",
            runs, list.front().settings.width, list.front().settings.height, MIN_BATCH, gpu.adapter().name, most);
    return sizes;
}

int CorrelateCommand::run()
{
    const passes::Settings base = readSettings();
    const std::vector<passes::NamedMethod> list = readMethods(base);
    NamedFiles files;
    for (const char* file : {"index.html", "correlate.csv", "settings.json"})
        files.writes("--output", std::filesystem::path(output) / file);
    motion.name(files);
    settings.name(files, base);
    files.reads("SCENE", scene.name);
    const Ranks& processes = ranks();
    Progress progress(quiet || processes.index() > 0);
    gpu::Device gpu = device.open();
    const std::vector<uint32_t> sizes = shareOut(gpu, list);

    std::vector<std::pair<std::string, std::string>> facts = {
        {"scene", scene.name}, {"device", gpu.adapter().name}, {"version", version()}};
    for (const auto& [name, value] : passes::toText(base))
        if (name != "method" && name != "seconds") facts.emplace_back(name, value);
    std::ranges::move(motionText(scene, motion), std::back_inserter(facts));
    for (const passes::NamedMethod& method : list)
        facts.emplace_back("method " + method.name, passes::hash(method.settings));
    scene::Scene world = openScene(scene, base, progress);
    const passes::Sequence sequence = motion.read(world, base, scene);

    const passes::CorrelationStore store(output);
    if (processes.index() == 0) store.open(facts, resume);
    if (const int failed = processes.meet(); failed != 0) return failed;
    if (processes.index() > 0) store.open(facts, true); // where directories are not shared, each has its own
    facts.emplace_back("runs", std::to_string(runs));   // a batch is the same however many there are
    facts.emplace_back("batches", std::to_string(sizes.size()));
    std::vector<passes::CorrelationBatch> batches = store.load(sizes);

    passes::Correlator correlator(
        std::make_unique<passes::Renderer>(
            gpu, world, passes::emissionSettings(base),
            passes::SceneOptions{
                .bvhProgress = [&](double fraction) { progress.show("Building the BVH", fraction, 1); },
                .moves = sequence.sceneMoves()}),
        base, list, sequence);
    progress.clear();

    // What this process has to do: items in the order of batches, dealt out in turns.
    struct Item {
        uint32_t index;
        size_t subject;
    };
    std::vector<Item> items;
    uint64_t turn = 0, frames = 0;
    for (uint32_t index = 0; index < sizes.size(); ++index)
        for (size_t i = 0; i < correlator.subjects().size(); ++i) {
            const passes::Correlator::Subject& subject = correlator.subjects()[i];
            const bool done = std::ranges::any_of(batches, [&](const passes::CorrelationBatch& b) {
                return b.index == index && b.method == subject.name;
            });
            if (turn++ % processes.count() != processes.index() || done) continue;
            items.push_back({index, i});
            frames += subject.lawFrames + subject.chainFrames;
        }

    const Interrupt interrupt;
    const auto start = Clock::now();
    uint64_t rendered = 0;
    for (const Item& item : items) {
        if (item.index > 0 && base.seconds > 0 && secondsSince(start) >= base.seconds) break;
        correlator.begin(item.subject, item.index, sizes[item.index]);
        do {
            correlator.step();
            progress.show("Correlating", double(++rendered), double(frames), "frames");
        } while (!correlator.complete() && !interrupt.requested());
        batches.push_back(correlator.batch());
        if (interrupt.requested()) break;
        store.save(batches.back());
    }
    progress.clear();

    std::vector<Bytes> records;
    for (const passes::CorrelationBatch& batch_ : batches) records.push_back(toBytes(batch_));
    passes::Correlation correlation{.scene = scene.name,
                                    .moving = sequence.moves(),
                                    .sameView = correlator.sameView(),
                                    .partial = interrupt.requested(),
                                    .width = base.width,
                                    .height = base.height,
                                    .runs = runs};
    batches.clear();
    for (const Bytes& record : processes.gather(records)) batches.push_back(passes::fromBytes(record));
    if (processes.index() > 0) return correlation.partial ? Interrupt::exitCode() : 0;
    evaluate(correlation, list, std::move(batches));
    std::string command = commandLine();
    if (processes.count() > 1) command = fmt::format("mpirun -n {} {}", processes.count(), command);
    writeCorrelation(output, correlation,
                     {.command = command,
                      .scene = scene.name,
                      .device = gpu.adapter().name,
                      .driver = gpu.adapter().driver,
                      .settings = facts,
                      .partial = correlation.partial});
    if (correlation.nonFinite > 0)
        fmt::print(stderr, "Warning: {} values were not finite and counted as 0.\n", correlation.nonFinite);
    for (const std::string& sentence : verdictsOf(correlation)) std::printf("%s\n", sentence.c_str());
    std::printf("The page: %s\n", (std::filesystem::path(output) / "index.html").c_str());
    if (!correlation.partial) return 0;
    std::fprintf(stderr, "Interrupted: %s is partial, marked so; --resume goes on with its finished batches.\n",
                 output.c_str());
    return Interrupt::exitCode();
}

} // namespace

Action setUpCorrelate(CLI::App& app)
{
    const auto command = std::make_shared<CorrelateCommand>();
    addSceneOptions(app, command->scene, SCENE_DOC)->required();
    app.add_option(
           "-o,--output", command->output,
           "Directory for correlate.csv, plots (autocovariance, lags, film), maps, and index.html, which holds them "
           "all. Made if it is missing.")
        ->option_text("DIR")
        ->required();
    addMethodsOption(app, command->methods, "restir-pt,rgb-restir");
    app.add_option(
           "--runs", command->runs,
           "Independent runs, over which covariances are taken. With temporal reuse alone pixels are independent "
           "chains too: pixels times runs is what decides the intervals. Cost grows with it.")
        ->option_text("6 to 1000000 runs (32)")
        ->check(within(2 * MIN_BATCH, 1000000u));
    app.add_option(
           "--batch", command->batch,
           "Runs rendered side by side. A finished batch is stored in DIR; processes share batches. Larger ones "
           "use a large GPU better; covariances are about the means of a batch.")
        ->option_text("3 to 1000 runs (16)")
        ->check(within(MIN_BATCH, 1000u));
    app.add_flag("--resume", command->resume,
                 "Goes on with the batches that DIR holds, of the same settings; with more --runs, too.");
    app.add_flag("--quiet", command->quiet, "No progress on the terminal.");
    command->device.addTo(app);
    command->motion.addTo(app);
    command->settings.addTo(app);
    app.footer("Renders frames up to --max-confidence (or --frames, if less; beyond, up to --max-confidence, the law "
               "predicts) and reports M = 2, 4, 8, ... of one chain. --seconds ends it after the batch at hand.");
    return [command] { return command->run(); };
}

} // namespace ui
