#include "ui/report/converge_page.h"

#include "engine/image/image.h"
#include "ui/report/crops.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace ui
{

namespace
{

using Json = nlohmann::json;
using passes::Lane;
using passes::Sample;
using Values = std::vector<double>;

std::string number(double value, const char* format = "{:.3g}")
{
    return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "–";
}

std::string medianText(const Values& values, const char* format = "{:.3g}")
{
    return number(passes::finiteMedian(values), format);
}

std::string withInterval(double value, const statistics::Interval& interval)
{
    if (!std::isfinite(value)) return "–";
    if (!std::isfinite(interval.low) || !std::isfinite(interval.high)) return number(value);
    return fmt::format("{:.3g} [{:.3g}, {:.3g}]", value, interval.low, interval.high);
}

// Of errors: the median, and the interval of the geometric mean.
std::string errorText(const Values& values)
{
    if (!passes::allAboveZero(values)) return medianText(values);
    return withInterval(statistics::median(values), statistics::factorOf(values).interval);
}

std::string ratioText(const Values& a, const Values& b)
{
    if (!passes::allAboveZero(a) || !passes::allAboveZero(b)) return "–";
    const statistics::Factor ratio = statistics::ratioOf(a, b);
    return withInterval(ratio.value, ratio.interval);
}

std::string meanText(const Values& values)
{
    statistics::Moments moments;
    for (const double value : values)
        if (std::isfinite(value)) moments.add(value);
    if (moments.count() == 0) return "–";
    const double degrees = double(moments.count() - 1);
    return withInterval(moments.mean(), statistics::meanInterval({moments.mean(), moments.varianceOfMean(), degrees}));
}

struct Writer {
    const ConvergeReport& report;
    passes::RaceFigures figures{report.repeats};
    std::vector<Lane> means = lanes(true), singles = lanes(false);
    double seconds = report.moving ? 0 : figures.commonSeconds(means);
    uint64_t frames = figures.commonFrames(singles);

    std::vector<Lane> lanes(bool average) const
    {
        std::vector<Lane> list;
        for (uint32_t method = 0; method < report.methods.size(); ++method) list.push_back({method, average});
        return list;
    }
    Lane pt(bool average) const { return {report.pt, average}; }
    const std::string& nameOf(Lane lane) const { return report.methods[lane.method].name; }

    // The least error that every method's mean comes down to.
    double commonError() const
    {
        double error = 0;
        for (const Lane lane : means)
            error = std::max(error, passes::finiteMedian(figures.at(lane, passes::RELMSE, seconds)));
        return error;
    }

    // What the path tracer has after as much time as the method's `frames` took: accumulating, or with a moving camera
    // with as many samples a pixel as fit into a frame.
    Values pathTracerInTimeOf(Lane lane, passes::Figure figure) const
    {
        if (report.moving) return figures.inTimeOf(lane, pt(false), figure, frames);
        const Values own = figures.secondsAfter(lane, frames);
        Values values;
        for (size_t r = 0; r < own.size(); ++r)
            values.push_back(statistics::errorAt(figures.curve(r, pt(true), figure), own[r])
                                 .value_or(std::numeric_limits<double>::quiet_NaN()));
        return values;
    }

    std::string millisecondsPerFrame(Lane lane) const
    {
        Values values;
        for (size_t r = 0; r < figures.repeats(); ++r) {
            const auto samples = figures.samples(r, lane);
            if (!samples.empty())
                values.push_back(1000 * figures.seconds(*samples.back()) / double(samples.back()->frames));
        }
        return medianText(values);
    }

    Json meansTable() const
    {
        const double error = commonError();
        std::vector<std::vector<std::string>> rows;
        for (const Lane lane : means) {
            const auto toPt = [&](passes::Figure figure) {
                return ratioText(figures.at(lane, figure, seconds), figures.at(pt(true), figure, seconds));
            };
            Values done;
            for (size_t r = 0; r < figures.repeats(); ++r) {
                double last = 0;
                for (const Sample* sample : figures.samples(r, lane))
                    if (figures.seconds(*sample) <= seconds * (1 + 1e-9)) last = double(sample->frames);
                done.push_back(last);
            }
            const Values times = figures.timesTo(lane, passes::RELMSE, error);
            const auto missed = std::ranges::count_if(times, [](double t) { return !std::isfinite(t); });
            rows.push_back(
                {nameOf(lane), medianText(done), millisecondsPerFrame(lane),
                 errorText(figures.at(lane, passes::RELMSE, seconds)), toPt(passes::RELMSE), toPt(passes::MSE),
                 toPt(passes::CHROMA_MSE), medianText(figures.linearAt(lane, passes::PSNR, seconds), "{:.2f}"),
                 medianText(figures.linearAt(lane, passes::SSIM, seconds), "{:.3f}"),
                 medianText(figures.linearAt(lane, passes::FLIP, seconds), "{:.3f}"),
                 missed > 0 ? fmt::format("{} ({} of {} repeats did not)", medianText(times), missed, times.size())
                            : medianText(times),
                 meanText(figures.slopes(lane, passes::RELMSE))});
        }
        const std::string least = fmt::format("{:.3g}", error);
        Json table = tableData({"method", "frames", "ms/frame", "relative MSE", "to pt", "MSE to pt",
                                "chroma MSE to pt", "PSNR dB", "SSIM", "FLIP", "s to " + least, "slope"},
                               rows);
        table["seconds"] = fmt::format("{:.3g}", seconds);
        table["error"] = least;
        return table;
    }

    Json singlesTable() const
    {
        std::vector<std::vector<std::string>> rows;
        for (const Lane lane : singles) {
            const Values errors = figures.after(lane, passes::RELMSE, frames);
            const auto inSameTime = [&](passes::Figure figure) {
                return ratioText(figures.after(lane, figure, frames), pathTracerInTimeOf(lane, figure));
            };
            rows.push_back({nameOf(lane), millisecondsPerFrame(lane), errorText(errors),
                            ratioText(errors, figures.after(pt(false), passes::RELMSE, frames)),
                            inSameTime(passes::RELMSE), inSameTime(passes::MSE), inSameTime(passes::LUMA_MSE),
                            inSameTime(passes::CHROMA_MSE),
                            medianText(figures.after(lane, passes::PSNR, frames), "{:.2f}"),
                            medianText(figures.after(lane, passes::SSIM, frames), "{:.3f}"),
                            medianText(figures.after(lane, passes::FLIP, frames), "{:.3f}")});
        }
        return tableData({"method", "ms/frame", "relative MSE", "to a frame of pt", "to pt, same time",
                          "MSE, same time", "luma MSE, same time", "chroma MSE, same time", "PSNR dB", "SSIM", "FLIP"},
                         rows);
    }

    std::vector<std::string> verdicts() const
    {
        const char* figure = "relative MSE";
        std::vector<std::string> sentences;
        const auto add = [&](const std::string& where, const std::vector<Lane>& lanes, const auto& errorsOf) {
            std::vector<statistics::Contender> contenders;
            for (const Lane lane : lanes) contenders.push_back({nameOf(lane), errorsOf(lane)});
            sentences.push_back(statistics::verdict(contenders, figure, where));
        };
        if (figures.repeats() == 0) return {"No repeat was measured, so nothing can be said."};
        if (!report.moving)
            add(fmt::format("In {} with a resting camera, means of all frames, equal time ({:.3g} s each):",
                            report.scene, seconds),
                means, [&](Lane lane) { return figures.at(lane, passes::RELMSE, seconds); });
        if (frames == 0) return sentences;
        add(fmt::format("In {} with a {} camera, single frames after {} of them:", report.scene,
                        report.moving ? "moving" : "resting", frames),
            singles, [&](Lane lane) { return figures.after(lane, passes::RELMSE, frames); });
        if (report.moving)
            add(fmt::format("In {} with a moving camera, equal time a frame (error times time: pt may trace more "
                            "samples):",
                            report.scene),
                singles, [&](Lane lane) {
                    Values costs = figures.after(lane, passes::RELMSE, frames);
                    const Values times = figures.secondsAfter(lane, frames);
                    for (size_t r = 0; r < costs.size(); ++r) costs[r] *= times[r];
                    return costs;
                });
        return sentences;
    }

    std::string referenceText() const
    {
        if (!report.referenceFile.empty())
            return fmt::format(
                "Errors are against \"{}\"; how precise that is is not known, and nothing is subtracted.",
                report.referenceFile);
        double worst = 0;
        uint64_t least = std::numeric_limits<uint64_t>::max(), missed = 0;
        for (const auto& [index, reference] : report.references) {
            worst = std::max(worst, std::sqrt(reference.error.relmse));
            least = std::min(least, reference.pathTraced);
            missed += !reference.precise;
        }
        if (report.references.empty()) return "There is no reference yet.";
        return fmt::format(
            "Errors are against {} path traced by the same program with other random numbers, {} frames or more each. "
            "Root of the reference's own relative MSE, estimated from its parts: {:.2g}{} (asked for: {:.2g}). The "
            "reference's own mean error is subtracted from relative MSE, MSE, luma and chroma MSE; PSNR, SSIM and FLIP "
            "are "
            "as measured.{}",
            report.references.size() == 1
                ? "a reference"
                : fmt::format("{} references (one per frame measured)", report.references.size()),
            least, worst, report.references.size() == 1 ? "" : " at worst", report.precision,
            missed > 0
                ? fmt::format(" {} of {} stopped at --reference-frames before they were as precise as asked for.",
                              missed, report.references.size())
                : "");
    }

    // The sum of relative squared errors over methods and channels; each is bounded, so that no bright pixel decides.
    image::Plane errorsAgainst(const image::Image& reference) const
    {
        image::Plane errors{int(reference.width), int(reference.height), std::vector<double>(reference.pixels.size())};
        for (const image::Image& picture : report.pictures)
            for (size_t i = 0; i < errors.values.size(); ++i) {
                const glm::dvec3 r(reference.pixels[i]), d = glm::dvec3(picture.pixels[i]) - r;
                for (int c = 0; c < 3; ++c)
                    errors.values[i] += std::min(d[c] * d[c] / (r[c] * r[c] + image::RELATIVE_EPSILON), 1.0);
            }
        return errors;
    }

    Json pictures() const
    {
        if (report.pictures.size() != report.methods.size() || report.references.empty()) return false;
        const image::Image& reference = report.references.rbegin()->second.picture;
        const glm::ivec2 size(std::max(reference.width / 4, 1u), std::max(reference.height / 4, 1u));
        const std::vector<Crop> worst = worstCrops(errorsAgainst(reference), size, 1);
        const Crop detail = worst.empty() ? Crop{.width = size.x, .height = size.y} : worst.front();
        Json shown;
        const auto add = [&](const image::Image& picture, const std::string& caption) {
            shown.push_back({{"caption", caption},
                             {"png", pngAddress(image::tonemappedPng(picture, {}))},
                             {"detail", pngAddress(image::tonemappedPng(cropped(picture, detail), {}))}});
        };
        add(reference, "reference");
        for (uint32_t method = 0; method < report.methods.size(); ++method) {
            const auto samples =
                figures.repeats() > 0 ? figures.samples(0, {method, !report.moving}) : std::vector<const Sample*>();
            std::string caption = report.methods[method].name;
            if (!samples.empty())
                caption += fmt::format(": {} frames, {:.3g} s, relative MSE {:.3g}", samples.back()->frames,
                                       figures.seconds(*samples.back()), samples.back()->error.relmse);
            add(report.pictures[method], caption);
        }
        return {{"shown", shown}};
    }
};

} // namespace

std::vector<std::string> convergeVerdicts(const ConvergeReport& report)
{
    return Writer{report}.verdicts();
}

std::string convergePage(const ConvergeReport& report, const std::vector<NamedPlot>& plots)
{
    const Writer writer{report};
    const bool measured = writer.figures.repeats() > 0;
    uint64_t nonFinite = 0;
    for (const passes::Repeat& repeat : report.repeats) nonFinite += repeat.nonFinite;
    Json curves = Json::array();
    for (const NamedPlot& plot : plots) curves.push_back({{"svg", inlineSvg(plot.svg)}, {"caption", plot.caption}});
    return fillPage("{{> converge.html}}",
                    {{"title", "Error against run time: " + report.scene},
                     {"verdicts", writer.verdicts()},
                     {"provenance", provenanceData(report.provenance)},
                     {"moving", report.moving},
                     {"repeats", std::to_string(writer.figures.repeats())},
                     {"frames", std::to_string(writer.frames)},
                     {"means", measured && !report.moving ? writer.meansTable() : Json(false)},
                     {"singles", measured && writer.frames > 0 ? writer.singlesTable() : Json(false)},
                     {"plots", curves},
                     {"pictures", writer.pictures()},
                     {"deviceClock", writer.figures.deviceClock()},
                     {"reference", writer.referenceText()},
                     {"nonFinite", std::to_string(nonFinite)}});
}

} // namespace ui
