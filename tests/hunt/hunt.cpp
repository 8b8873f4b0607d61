// Random scenes and settings against truth, for as long as somebody likes: ./run hunt MINUTES. What is found is made
// small and written as files with the command lines that show it.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "engine/base/clock.h"
#include "engine/base/error.h"
#include "tests/hunt/case_file.h"
#include "tests/hunt/shrink.h"
#include "tests/hunt/trial.h"
#include "tests/support/planted_shaders.h"

namespace
{

using hunt::Case, hunt::Finding;

struct Options {
    double minutes = 5, shrinkSeconds = 120, effort = 1;
    uint64_t seed = 1, most = 0; // most finds; 0: no limit
    std::string device, plant, out = "build/hunt", file;
    hunt::Wanted wanted;
    int64_t number = -1;
    bool verbose = false;
};

// A device and what it has compiled.
struct Place {
    gpu::Device device;
    std::shared_ptr<passes::PipelinePool> pipelines;
    explicit Place(const gpu::DeviceDescriptor& descriptor)
        : device(gpu::Device::create(descriptor)), pipelines(std::make_shared<passes::PipelinePool>(device))
    {
    }
};

class Hunt
{
  public:
    explicit Hunt(const Options& options) : options_(options)
    {
        if (options.plant.empty()) return;
        planted_.emplace("hunt_" + options.plant);
        planted_->plant(support::plantedError(options.plant));
    }

    uint64_t run()
    {
        if (!options_.file.empty()) {
            Place place(descriptor(false));
            tryCase(place, hunt::readCase(options_.file));
            return found_;
        }
        const bool one = options_.number >= 0;
        const uint64_t first = one ? uint64_t(options_.number) / hunt::SESSION_CASES : 0;
        for (uint64_t index = first; !over(); ++index) {
            const hunt::Session session(options_.seed, index, options_.wanted);
            Place place(descriptor(index % VALIDATED == VALIDATED - 1));
            const uint64_t from = one ? uint64_t(options_.number) % hunt::SESSION_CASES : 0;
            for (uint64_t i = from; i < hunt::SESSION_CASES && !over(); ++i) {
                const Clock::time_point start = Clock::now();
                tryCase(place, session.draw(i));
                spent_[i == from ? "first cases, which compile" : "other cases"] += secondsSince(start);
                if (secondsSince(start_) > reported_ + 60) report();
                if (one) return found_;
            }
        }
        report();
        for (const auto& [what, seconds] : spent_) std::fprintf(stderr, "%6.0f s for %s\n", seconds, what.c_str());
        return found_;
    }

  private:
    static constexpr uint64_t VALIDATED = 8, REPEATED = 8; // every so many sessions, cases
    static constexpr uint64_t SHRUNK = 2;                  // of what looks alike
    static constexpr double SAME_GAP = 0.05;               // of the first find's: a smaller one shows something else

    bool over() const
    {
        return (options_.number < 0 && secondsSince(start_) > 60 * options_.minutes) ||
               (options_.most > 0 && found_ >= options_.most);
    }

    gpu::DeviceDescriptor descriptor(bool validation) const
    {
        return {.adapter = options_.device,
                .validation = validation,
                .shaderDirectory = planted_ ? planted_->folder().string() : std::string()};
    }

    uint64_t seedOf(const Case& c) const { return hunt::Draw::mix(options_.seed ^ hunt::Draw::mix(c.number)); }

    void tryCase(Place& place, const Case& c)
    {
        const Finding finding = hunt::examine(place.device, place.pipelines, c, seedOf(c),
                                              {.factor = options_.effort, .repeats = c.number % REPEATED == 0});
        ++cases_;
        suspicious_ += finding.stages > 1;
        undecided_ += finding.fault == hunt::Fault::Undecided;
        found_ += finding.found();
        if (finding.found() || options_.verbose || options_.number >= 0 || !options_.file.empty() ||
            finding.fault == hunt::Fault::Undecided)
            say("{:.1f} min, {:.1f} min of processors: {}\n    {}", secondsSince(start_) / 60,
                double(std::clock()) / CLOCKS_PER_SEC / 60, c.describe(), finding.describe());
        if (finding.found())
            keep(c, finding);
        else if (options_.number >= 0)
            hunt::writeCase(stemOf(c), c, finding.describe());
    }

    // Its files, without their endings.
    std::string stemOf(const Case& c) const
    {
        return fmt::format("{}/{}-{}-{}", options_.out, hunt::KIND_NAMES[size_t(c.kind)], options_.seed, c.number);
    }

    // Small, as files.
    void keep(const Case& c, const Finding& finding)
    {
        const std::string alike =
            fmt::format("{}-{}-{}", hunt::KIND_NAMES[size_t(c.kind)], hunt::TRUTH_NAMES[size_t(c.truth)],
                        hunt::FAULT_NAMES[size_t(finding.fault)]);
        if (++alike_[alike] > SHRUNK || finding.fault > hunt::Fault::NotFinite) return;
        const Clock::time_point start = Clock::now();
        Place place(descriptor(false));
        uint64_t tries = 0;
        const auto fails = [&](const Case& smaller) {
            const hunt::Effort effort = {.factor = 2 * options_.effort, .stages = 2, .firstLevel = 1e-5};
            const Finding now = hunt::examine(place.device, place.pipelines, smaller, seedOf(c) + ++tries, effort);
            return now.fault == finding.fault &&
                   std::abs(now.tried - now.truth) >= SAME_GAP * std::abs(finding.tried - finding.truth);
        };
        const Case small = hunt::shrink(c, fails, [&] { return secondsSince(start) > options_.shrinkSeconds; });
        const std::string stem = stemOf(c);
        hunt::writeCase(stem, small, finding.describe());
        const Finding again =
            hunt::examine(place.device, place.pipelines, hunt::readCase(stem + ".json"), seedOf(c) + ++tries);
        say("    smallest ({} tries): {}\n    {}.gltf and .json {}", tries, small.describe(), stem,
            again.found() ? "show it: " + again.describe()
                          : fmt::format("do not show it; --case {} with the same other options does", c.number));
        spent_["making finds small"] += secondsSince(start);
    }

    void report()
    {
        reported_ = secondsSince(start_);
        std::fprintf(stderr, "%s\n",
                     fmt::format("{:.0f} min: {} cases, {} suspicious, {} undecided, {} found", reported_ / 60, cases_,
                                 suspicious_, undecided_, found_)
                         .c_str());
    }

    template <class... Args>
    void say(fmt::format_string<Args...> format, Args&&... args) const
    {
        std::printf("%s\n", fmt::format(format, std::forward<Args>(args)...).c_str());
        std::fflush(stdout);
    }

    const Options options_;
    std::optional<support::PlantedShaders> planted_;
    const Clock::time_point start_ = Clock::now();
    double reported_ = 0; // seconds
    uint64_t cases_ = 0, suspicious_ = 0, undecided_ = 0, found_ = 0;
    std::map<std::string, uint64_t> alike_;
    std::map<std::string, double> spent_;
};

} // namespace

int main(int argc, char** argv)
{
    Options options;
    std::vector<std::string> settings;
    CLI::App app("Random scenes and settings against truth. Ends with 1 when something was found.");
    app.add_option("MINUTES", options.minutes, "How long.");
    app.add_option("--seed", options.seed, "Of all cases.");
    app.add_option("--only", options.wanted.kind,
                   fmt::format("One kind of scene: {}.", fmt::join(hunt::KIND_NAMES, ", ")));
    app.add_option("--against", options.wanted.truth,
                   "One truth, where a scene has two: pt (for estimators), reference (for pt).");
    app.add_option("--setting", settings, "Settings that all cases have, as NAME=VALUE: color=weighted.")
        ->check([](const std::string& text) {
            return text.find('=') == std::string::npos ? "write it as NAME=VALUE" : std::string();
        });
    app.add_option("--effort", options.effort, "How many times the usual samples: fewer cases, smaller biases.")
        ->check(CLI::Range(0.1, 1000.0));
    app.add_option(
        "--case", options.number,
        "One case of that seed (and --only, --against, --setting, --effort), and no other; its files are written.");
    app.add_option("--file", options.file, "The case of a .json that was written, and no other.");
    app.add_option("--plant", options.plant, "An error to plant in the shaders: would it be found?");
    app.add_option("--most", options.most, "Ends after so many finds.");
    app.add_option("--shrink", options.shrinkSeconds, "How long a find may be made smaller, in seconds.");
    app.add_option("--out", options.out, "Where finds are written.");
    app.add_option("--device", options.device, "Index, or part of its name.");
    app.add_flag("--on-itself", options.wanted.onItself,
                 "Compares the path tracer with itself: what is found is a false alarm.");
    app.add_flag("--verbose", options.verbose, "Names every case.");
    CLI11_PARSE(app, argc, argv);
    for (const std::string& text : settings) {
        const size_t equals = text.find('=');
        options.wanted.settings.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    }
    try {
        return Hunt(options).run() > 0 ? EXIT_FAILURE : EXIT_SUCCESS;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "hunt: %s\n", error.what());
        return 2;
    }
}
