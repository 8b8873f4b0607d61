#include "tests/hunt/trial.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "engine/base/error.h"

namespace hunt
{

namespace
{

using statistics::Estimate, statistics::Moments;
using support::PixelEstimates;

// What is compared: pixels whose mean is one quantity.
struct Region {
    std::string name;
    std::vector<uint32_t> pixels;
};

// The picture, its quarters and its pixels, without those that float64 cannot decide about.
std::vector<Region> regionsOf(uint32_t width, uint32_t height, const std::vector<bool>& undefined)
{
    std::vector<Region> coarse = {
        {"whole picture", {}}, {"top left", {}}, {"top right", {}}, {"bottom left", {}}, {"bottom right", {}}};
    std::vector<Region> single;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const uint32_t pixel = y * width + x;
            if (!undefined.empty() && undefined[pixel]) continue;
            coarse[0].pixels.push_back(pixel);
            coarse[1 + (2 * y >= height ? 2 : 0) + (2 * x >= width ? 1 : 0)].pixels.push_back(pixel);
            single.push_back({fmt::format("pixel ({}, {})", x, y), {pixel}});
        }
    std::erase_if(coarse, [](const Region& region) { return region.pixels.empty(); });
    coarse.insert(coarse.end(), single.begin(), single.end());
    return coarse;
}

double valueOf(const Region& region, std::span<const glm::vec3> pixels, int channel)
{
    double sum = 0;
    for (const uint32_t pixel : region.pixels) sum += double(pixels[pixel][channel]);
    return sum / double(region.pixels.size());
}

Estimate estimateOf(const Region& region, const PixelEstimates& picture, size_t channel)
{
    Estimate sum;
    double spread = 0;
    const double n = double(region.pixels.size());
    for (const uint32_t pixel : region.pixels) {
        const Estimate& e = picture.pixels[pixel][channel];
        sum.mean += e.mean / n;
        sum.varianceOfMean += e.varianceOfMean / (n * n);
        spread += std::pow(e.varianceOfMean / (n * n), 2) / e.degreesOfFreedom; // Welch and Satterthwaite
    }
    sum.degreesOfFreedom = spread > 0 ? sum.varianceOfMean * sum.varianceOfMean / spread : INFINITY;
    return sum;
}

// How many times the first stage's samples a later one takes at most; the last one, which has to know what it has
// missed.
constexpr uint64_t MOST = 4, MOST_AT_LAST = 32;
constexpr uint64_t FIRST_FRAMES = 8192;     // of the path tracer, in 8x8 pixels
constexpr double Z_WANTED = 9;              // standard errors: the last level takes 5.7 of them
constexpr double ROUNDING = 5e-4;           // of the larger mean: both methods run the same float32 code on the device
constexpr double REFERENCE_ROUNDING = 3e-3; // float64 against octahedral normals, half colors and float32

class Examination
{
  public:
    Examination(gpu::Device& device, const std::shared_ptr<passes::PipelinePool>& pipelines, const Case& c,
                uint64_t seed, const Effort& effort)
        : case_(c), stand_(device, pipelines, c), seed_(seed), effort_(effort),
          pathTracing_(c.settings.method == passes::Method::Pt && c.truth != Truth::PathTracer),
          reference_(c.truth == Truth::Reference)
    {
        const double pixels = double(c.settings.width) * c.settings.height;
        runs_ = uint64_t(effort.factor * stand_.batch());
        frames_ = std::max(uint64_t(effort.factor * double(FIRST_FRAMES) * 64 / pixels), uint64_t{64});
        const double tests = pixels * double(c.scene.triangles.size()) * 2 * (c.settings.maxBounces + 1);
        samples_ = uint64_t(effort.factor * std::clamp(3e7 / tests, 64.0, 4096.0));
    }

    Finding run()
    {
        Finding finding = case_.truth == Truth::Black ? black() : differences();
        std::vector<std::string> broken;
        for (const auto& [stage, values] : stand_.nonFinite())
            if (values > 0) broken.push_back(fmt::format("{} values in {}", values, stage));
        if (!broken.empty()) {
            finding.fault = Fault::NotFinite;
            finding.where = fmt::format("{}", fmt::join(broken, ", "));
        } else if (!finding.found() && effort_.repeats && !repeats()) {
            finding.fault = Fault::NotRepeatable;
        }
        return finding;
    }

  private:
    uint64_t seedOf(int stage, uint64_t side) const { return Draw::mix(seed_ + 2 * uint64_t(stage) + side); }
    uint64_t scale() const { return growth_; }

    void trial(int stage, const TakeRun& take)
    {
        if (pathTracing_)
            stand_.frames(seedOf(stage, 0), frames_ * scale(), take);
        else
            stand_.runs(seedOf(stage, 0), runs_ * scale(), take);
    }

    Finding black()
    {
        Finding finding{.fault = Fault::None, .stages = 1};
        uint64_t lit = 0, all = 0;
        for (int stage = 0; stage < (lit > 0 ? 2 : 1); ++stage, growth_ = 4)
            trial(stage, [&](std::span<const glm::vec3> pixels) {
                for (size_t i = 0; i < pixels.size(); ++i, ++all) {
                    if (pixels[i] == glm::vec3(0)) continue;
                    ++lit;
                    finding.fault = Fault::Light;
                    finding.tried =
                        std::max(finding.tried, double(std::max(pixels[i].x, std::max(pixels[i].y, pixels[i].z))));
                }
            });
        finding.where = fmt::format("{} of {} pixel values", lit, all);
        return finding;
    }

    Finding differences()
    {
        const std::vector<Region> regions = regionsOf(case_.settings.width, case_.settings.height,
                                                      reference_ ? stand_.undefinedPixels() : std::vector<bool>());
        if (regions.empty()) return {};
        Finding finding = first(regions);
        for (int stage = 1; finding.fault == Fault::Different && stage < effort_.stages; ++stage) {
            // What is obvious is shown again with few samples, and what few cannot decide with more.
            const double most = double(isLast(stage) ? MOST_AT_LAST : MOST);
            const double z = std::max(std::abs(finding.tried - finding.truth) / finding.standardError, 1.0);
            growth_ = uint64_t(std::clamp(std::ceil(std::pow(Z_WANTED / z, 2) * double(growth_)), 1.0, most));
            finding = again(stage, stage, regions[region_], LEVELS[stage]);
            if (finding.fault == Fault::Different || double(growth_) == most) continue;
            growth_ = uint64_t(most);
            finding = again(stage, stage + 2, regions[region_], LEVELS[stage] / 2);
        }
        return finding;
    }

    bool isLast(int stage) const { return stage + 1 == effort_.stages; }

    // The last stage asks what may be missing.
    Comparison compared(int stage, const Values& tried, const Values& truth, double level) const
    {
        return isLast(stage) ? compare(tried, truth, level, margin())
                             : compare(tried.estimate, truth.estimate, level, margin());
    }

    double margin() const { return reference_ ? REFERENCE_ROUNDING : ROUNDING; }

    Finding report(int stage, const Region& region, const Comparison& comparison, const Estimate& tried,
                   const Estimate& truth) const
    {
        constexpr Fault FAULTS[] = {Fault::None, Fault::Undecided, Fault::Different};
        return {.fault = FAULTS[size_t(comparison.answer)],
                .stages = stage + 1,
                .where = fmt::format("{}, channel {}", region.name, channel_),
                .tried = tried.mean,
                .truth = truth.mean,
                .standardError = comparison.difference.standardError,
                .p = comparison.p};
    }

    // All regions; half of the level is for the coarse ones, half for the pixels.
    Finding first(const std::vector<Region>& regions)
    {
        using Table = std::vector<std::array<Moments, 3>>;
        Table tried(regions.size()), truth(regions.size());
        const auto addTo = [&](Table& table) {
            return [&](std::span<const glm::vec3> pixels) {
                for (size_t i = 0; i < regions.size(); ++i)
                    for (int c = 0; c < 3; ++c) table[i][size_t(c)].add(valueOf(regions[i], pixels, c));
            };
        };
        trial(0, addTo(tried));
        PixelEstimates reference;
        if (reference_)
            reference = stand_.reference(seedOf(0, 1), samples_);
        else
            stand_.frames(seedOf(0, 1), frames_, addTo(truth));

        const size_t coarse =
            size_t(std::ranges::count_if(regions, [](const Region& r) { return r.pixels.size() > 1; }));
        double least = 1;
        Finding finding;
        for (size_t i = 0; i < regions.size(); ++i)
            for (size_t c = 0; c < 3; ++c) {
                const bool isCoarse = regions[i].pixels.size() > 1;
                const double tests = 2 * 3 * double(isCoarse ? coarse : regions.size() - coarse);
                const Estimate here = statistics::estimateOf(tried[i][c]);
                const Estimate there =
                    reference_ ? estimateOf(regions[i], reference, c) : statistics::estimateOf(truth[i][c]);
                Comparison comparison = compare(here, there, effort_.firstLevel / tests, margin());
                comparison.p = std::min(comparison.p * tests, 1.0);
                if (comparison.answer == Answer::Agree || comparison.p > least) continue;
                least = comparison.p;
                region_ = i;
                channel_ = c;
                finding = report(0, regions[i], comparison, here, there);
            }
        finding.stages = 1;
        if (!reference_) setDimness(regions, truth);
        return finding;
    }

    // One region with fresh numbers and more of them.
    Finding again(int stage, int stream, const Region& region, double level)
    {
        Values tried, truth;
        const auto addTo = [&](Values& values) {
            return [&](std::span<const glm::vec3> pixels) { values.add(valueOf(region, pixels, int(channel_))); };
        };
        trial(stream, addTo(tried));
        if (pathTracing_)
            tried.finish(1);
        else
            tried.finish(stand_.chancesPerRun() * dimness_, reach(region));
        if (!reference_) {
            stand_.frames(seedOf(stream, 1), frames_ * scale(), addTo(truth));
            truth.finish(1);
            return report(stage, region, compared(stage, tried, truth, level), tried.estimate, truth.estimate);
        }
        const uint64_t samples = samples_ * scale();
        const auto referenceIs = [&](double leastPick) {
            truth.estimate = estimateOf(region, stand_.reference(seedOf(stream, 1), samples, leastPick), channel_);
            truth.chances = double(samples);
        };
        referenceIs(0);
        Finding finding = report(stage, region, compared(stage, tried, truth, level), tried.estimate, truth.estimate);
        // The float64 tracer samples every light at every vertex, the path tracer picks one: what it has hardly picked
        // may be missing.
        const double enough = ENOUGH_EVENTS / tried.chances;
        if (finding.fault != Fault::Different || finding.tried > finding.truth || stand_.leastPick() >= enough)
            return finding;
        referenceIs(enough);
        const bool still =
            tried.estimate.mean < truth.estimate.mean && compared(stage, tried, truth, level).answer == Answer::Differ;
        if (!still) finding.fault = Fault::Undecided;
        return finding;
    }

    // Frames and neighbors whose paths a run can show in the region.
    double reach(const Region& region) const
    {
        const passes::Settings& s = case_.settings;
        const double pixels = double(s.width) * s.height / double(region.pixels.size());
        return double(s.temporal ? s.frames : 1) * (s.spatial > 0 ? pixels : 1);
    }

    // What a pixel shows of its neighbors' dim paths is chosen as rarely as it is dim beside what they have brighter.
    void setDimness(const std::vector<Region>& regions, const std::vector<std::array<Moments, 3>>& truth)
    {
        double brightest = 0;
        for (size_t i = 0; i < regions.size(); ++i)
            if (regions[i].pixels.size() == 1)
                for (const Moments& channel : truth[i]) brightest = std::max(brightest, channel.mean());
        dimness_ = brightest > 0 ? std::min(truth[region_][channel_].mean() / brightest, 1.0) : 1;
    }

    bool repeats()
    {
        std::vector<glm::vec3> once, twice;
        for (std::vector<glm::vec3>* all : {&once, &twice}) {
            const TakeRun take = [&](std::span<const glm::vec3> p) { all->insert(all->end(), p.begin(), p.end()); };
            if (pathTracing_)
                stand_.frames(seed_, 1, take);
            else
                stand_.runs(seed_, 1, take);
        }
        return once.size() == twice.size() &&
               std::memcmp(once.data(), twice.data(), once.size() * sizeof(glm::vec3)) == 0;
    }

    const Case& case_;
    Stand stand_;
    uint64_t seed_;
    Effort effort_;
    bool pathTracing_, reference_;
    uint64_t runs_ = 0, frames_ = 0, samples_ = 0; // of the first stage
    size_t region_ = 0, channel_ = 0;              // what it named
    double dimness_ = 1;                           // of that, beside the brightest pixel
    uint64_t growth_ = 1;                          // of the samples since then
};

} // namespace

std::string Finding::describe() const
{
    std::string text = FAULT_NAMES[size_t(fault)];
    if (!where.empty()) text += ": " + where;
    if (fault == Fault::Different || fault == Fault::Undecided)
        text += fmt::format(", {:.6g} where the truth is {:.6g}, standard error {:.2g}, p = {:.2g}", tried, truth,
                            standardError, p);
    if (fault == Fault::Light) text += fmt::format(", up to {:.3g}", tried);
    return text;
}

Finding examine(gpu::Device& device, const std::shared_ptr<passes::PipelinePool>& pipelines, const Case& c,
                uint64_t seed, const Effort& effort)
{
    Finding finding;
    try {
        finding = Examination(device, pipelines, c, seed, effort).run();
    } catch (const Error& error) {
        finding = {.fault = Fault::Failed, .where = error.what()};
    }
    const std::vector<std::string> messages = device.takeValidationMessages();
    if (!messages.empty()) finding = {.fault = Fault::Validation, .where = messages.front()};
    return finding;
}

} // namespace hunt
