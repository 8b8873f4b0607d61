// Random scenes and settings against truth, for ever: ./run hunt MINUTES.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "engine/base/error.h"
#include "tests/hunt/trial.h"

namespace
{

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Options {
    double minutes = 5;
    uint64_t seed = 1;
    std::string only, device;
    int64_t number = -1;
};

struct Counts {
    uint64_t cases = 0, suspicious = 0, undecided = 0, found = 0;
};

void hunt_(const Options& options)
{
    const Clock::time_point start = Clock::now();
    Counts counts;
    double reported = 0;
    const uint64_t firstSession = options.number >= 0 ? uint64_t(options.number) / hunt::SESSION_CASES : 0;
    for (uint64_t index = firstSession;; ++index) {
        const hunt::Session session(options.seed, index, options.only);
        gpu::Device device = gpu::Device::create({.adapter = options.device, .validation = index % 4 == 3});
        const auto pipelines = std::make_shared<passes::PipelinePool>(device);
        const uint64_t firstPlace = options.number >= 0 ? uint64_t(options.number) % hunt::SESSION_CASES : 0;
        for (uint64_t place = firstPlace; place < hunt::SESSION_CASES; ++place) {
            if (secondsSince(start) > 60 * options.minutes && options.number < 0) return;
            const hunt::Case c = session.draw(place);
            const Clock::time_point caseStart = Clock::now();
            const hunt::Finding finding =
                hunt::examine(device, pipelines, c, hunt::Draw::mix(options.seed ^ hunt::Draw::mix(c.number)),
                              {.repeats = place % 8 == 0});
            ++counts.cases;
            counts.suspicious += finding.stages > 1;
            counts.undecided += finding.fault == hunt::Fault::Undecided;
            counts.found += finding.found();
            const double seconds = secondsSince(caseStart);
            if (finding.found() || options.number >= 0 || std::getenv("HUNT_VERBOSE"))
                std::printf("%.0f s, %.2f s: %s\n  %s\n", secondsSince(start), seconds, c.describe().c_str(),
                            finding.describe().c_str());
            std::fflush(stdout);
            for (const std::string& message : device.takeValidationMessages())
                std::printf("validation: %s\n", message.c_str());
            if (secondsSince(start) > reported + 60) {
                reported = secondsSince(start);
                std::fprintf(stderr, "%.0f min: %llu cases, %llu suspicious, %llu undecided, %llu found\n",
                             reported / 60, (unsigned long long)counts.cases, (unsigned long long)counts.suspicious,
                             (unsigned long long)counts.undecided, (unsigned long long)counts.found);
            }
            if (options.number >= 0) return;
        }
    }
}

} // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App app("Random scenes and settings against truth, for ever.");
    app.add_option("MINUTES", options.minutes, "How long.");
    app.add_option("--seed", options.seed, "Of all cases.");
    app.add_option("--only", options.only, "One kind of scene.");
    app.add_option("--case", options.number, "One case of that seed (and --only), and no more.");
    app.add_option("--device", options.device, "Index, or part of its name.");
    CLI11_PARSE(app, argc, argv);
    try {
        hunt_(options);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "hunt: %s\n", error.what());
        return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}
