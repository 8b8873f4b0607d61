#include "passes/experiments/advice.h"

#include "engine/base/error.h"
#include "passes/camera_path.h"
#include "passes/experiments/autocovariance.h"
#include "passes/experiments/race_figures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace passes
{

namespace
{

constexpr double PIXELS = 96 * 54; // of the pictures that are measured, at most
constexpr double DEGREES = 0.3;    // a frame
constexpr uint64_t FRAMES = 8;     // of which the last one counts
constexpr size_t REPEATS = 8;
constexpr uint32_t LAW_FRAMES = 48, LAW_RUNS = 8;
constexpr Precision PRECISION{.error = 0.05, .maxFrames = 2048};
constexpr double RACE_SHARE = 0.9; // of the time, roughly

struct Candidate {
    const char* name;
    Method method;
    Color color;
};
constexpr Candidate CANDIDATES[] = {{"restir-pt:color=weighted", Method::RestirPt, Color::Weighted},
                                    {"restir-pt:color=variate", Method::RestirPt, Color::Variate},
                                    {"rgb-restir", Method::RgbRestir, Color::Weighted}};

FrameLaw lawOf(const Renderer& sharing, const Settings& settings, const image::Image& emission)
{
    Renderer renderer(sharing, lawSettings(settings), LAW_RUNS);
    LawMeter meter(renderer, emission);
    while (meter.frames() < LAW_FRAMES) meter.step();
    return meter.law();
}

} // namespace

size_t Advice::best() const
{
    const auto most = std::ranges::max_element(rows, {}, [](const Row& row) { return row.gain.value; });
    for (size_t i = 0; i < rows.size(); ++i) // the cheapest first
        if (rows[i].gain.interval.high >= most->gain.interval.low) return i;
    return 0;
}

Advice advise(gpu::Device& device, const scene::Scene& scene, const Settings& settings,
              const std::function<void(double)>& progress, const std::function<bool()>& stop)
{
    Settings base = settings;
    const double scale = std::min(1.0, std::sqrt(PIXELS / (double(base.width) * base.height)));
    base.width = std::max(1u, uint32_t(std::lround(base.width * scale)));
    base.height = std::max(1u, uint32_t(std::lround(base.height * scale)));
    base.temporal = true;
    std::vector<Settings> methods;
    for (const Candidate& candidate : CANDIDATES) {
        methods.push_back(base);
        methods.back().method = candidate.method;
        methods.back().color = candidate.color;
    }
    std::ranges::reverse(methods); // the race lends its first renderer: RGB's

    const Sequence sequence(cameraOrbit(scene.cameras.at(chooseCamera(scene, base.camera)), DEGREES));
    Race race(device, scene, methods, sequence, {.frames = FRAMES});
    References references(race.renderer(), base, sequence, {.precision = PRECISION, .cache = {}, .stop = stop});
    std::vector<Repeat> repeats;
    for (uint64_t seed = 0; seed < REPEATS && !stop(); ++seed) {
        const auto part = [&](double done) { progress(RACE_SHARE * (double(seed) + done) / double(REPEATS)); };
        repeats.push_back(race.run(base.seed + seed, references, part, stop));
    }
    if (stop()) throw Error("Interrupted before there was any advice.");

    Advice advice{.treesPerPixel = race.renderer().stats().treesPerPixel,
                  .width = base.width,
                  .height = base.height,
                  .degrees = DEGREES};
    const RaceFigures figures(repeats);
    std::vector<double> first;
    for (size_t i = 0; i < std::size(CANDIDATES); ++i) {
        const Lane lane{.method = uint32_t(std::size(CANDIDATES) - 1 - i), .average = false};
        const std::vector<double> errors = figures.after(lane, RELMSE, FRAMES);
        const std::vector<double> seconds = figures.secondsAfter(lane, FRAMES);
        std::vector<double> costs;
        for (size_t r = 0; r < errors.size(); ++r) costs.push_back(errors[r] * seconds[r]);
        if (!allAboveZero(costs))
            throw Error("There is no advice: at {}x{} pixels {} is as precise as what it would be measured against.",
                        base.width, base.height, CANDIDATES[i].name);
        if (i == 0) first = costs;
        advice.rows.push_back({.method = CANDIDATES[i].name,
                               .milliseconds = 1e3 * finiteMedian(seconds) / double(FRAMES),
                               .error = finiteMedian(errors),
                               .gain = i == 0 ? statistics::Factor{1, {1, 1}} : statistics::ratioOf(first, costs)});
    }

    Renderer emitters(race.renderer(), emissionSettings(base));
    emitters.renderFrame();
    const image::Image emission = emitters.read(LAST_FRAME);
    Settings plain = base;
    plain.method = Method::Pt;
    Settings one = base;
    one.method = Method::RestirPt;
    advice.variance = lawOf(race.renderer(), plain, emission).variance.value;
    progress((1 + RACE_SHARE) / 2);
    advice.plateau = lawOf(race.renderer(), one, emission).plateau.value;
    progress(1);
    return advice;
}

std::vector<std::string> sentencesOf(const Advice& advice, const Settings& settings)
{
    const Advice::Row& best = advice.rows.at(advice.best());
    std::vector<std::string> sentences;
    sentences.push_back(fmt::format(
        "Use {}: under a camera that turns by {} degrees a frame, with K = {}, M_c = {} and {} shifts, {}.",
        best.method, advice.degrees, settings.spatial, settings.maxConfidence, WORDS_OF<Shift>[size_t(settings.shift)],
        &best == &advice.rows.front()
            ? std::string("no other has less error in the same time, as far as this can tell")
            : fmt::format("it has {:.2g} times ({:.2g} to {:.2g}) less error than {} in the same time", best.gain.value,
                          best.gain.interval.low, best.gain.interval.high, advice.rows.front().method)));
    for (const Advice::Row& row : advice.rows)
        sentences.push_back(fmt::format(
            "    {:<26}{:>9.2f} ms a frame, relative MSE {:.3g}{}", row.method, row.milliseconds, row.error,
            &row == &advice.rows.front() ? ""
                                         : fmt::format(", {:.2g} times less in the same time ({:.2g} to {:.2g})",
                                                       row.gain.value, row.gain.interval.low, row.gain.interval.high)));
    sentences.push_back(
        advice.crossover() > 0
            ? fmt::format(
                  "Color noise that no history removes (P = {:.3g}) is seen with one reservoir after about M* = "
                  "{:.3g} frames of history; {}.",
                  advice.plateau, advice.crossover(),
                  settings.maxConfidence > advice.crossover()
                      ? "M_c lets history grow beyond that"
                      : "M_c ends history before that, so that color is not what limits a frame")
            : std::string("One reservoir has no color noise here that history would not remove."));
    sentences.push_back(
        fmt::format("The reservoirs of the three channels hold {:.2f} different paths in the mean: so many "
                    "walks rgb-restir takes for each of restir-pt.",
                    advice.treesPerPixel));
    sentences.push_back(fmt::format("Measured at {}x{}, {} repeats; converge measures longer and shows more.",
                                    advice.width, advice.height, REPEATS));
    return sentences;
}

} // namespace passes
