#include "ui/report/converge_page.h"

#include "engine/image/image.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace ui
{

namespace
{

using passes::Lane;
using passes::Sample;
using Values = std::vector<double>;

double relmseOf(const Sample& s)
{
    return s.error.relmse;
}
double mseOf(const Sample& s)
{
    return s.error.mse;
}
double chromaOf(const Sample& s)
{
    return s.error.chromaMse;
}
double lumaOf(const Sample& s)
{
    return s.error.lumaMse;
}
double psnrOf(const Sample& s)
{
    return s.error.psnr;
}
double ssimOf(const Sample& s)
{
    return s.error.ssim;
}
double flipOf(const Sample& s)
{
    return s.error.flip;
}

std::string number(double value, const char* format = "{:.3g}")
{
    return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "–";
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
    if (!passes::allAboveZero(values)) return number(passes::finiteMedian(values));
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

Values product(Values a, const Values& b)
{
    for (size_t i = 0; i < a.size(); ++i) a[i] *= b[i];
    return a;
}

Values quotient(Values a, const Values& b)
{
    for (size_t i = 0; i < a.size(); ++i) a[i] /= b[i];
    return a;
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
            error = std::max(error, passes::finiteMedian(figures.at(lane, relmseOf, seconds)));
        return error;
    }

    // What the path tracer has after as much time as the method's `frames` took: accumulating, or with a moving camera
    // with as many samples a pixel as fit into a frame.
    Values pathTracerInTimeOf(Lane lane, passes::Figure figure) const
    {
        const Values own = figures.secondsAfter(lane, frames);
        if (report.moving)
            return product(figures.after(pt(false), figure, frames),
                           quotient(figures.secondsAfter(pt(false), frames), own));
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
        return number(passes::finiteMedian(values));
    }

    void meansTable(Page& page) const
    {
        const double error = commonError();
        page.heading(fmt::format("Means of all frames, after {:.3g} s of each method", seconds));
        std::vector<std::vector<std::string>> rows;
        for (const Lane lane : means) {
            Values done;
            for (size_t r = 0; r < figures.repeats(); ++r) {
                double last = 0;
                for (const Sample* sample : figures.samples(r, lane))
                    if (figures.seconds(*sample) <= seconds * (1 + 1e-9)) last = double(sample->frames);
                done.push_back(last);
            }
            const Values times = figures.timesTo(lane, relmseOf, error);
            const auto missed = std::ranges::count_if(times, [](double t) { return !std::isfinite(t); });
            rows.push_back({nameOf(lane), number(passes::finiteMedian(done)), millisecondsPerFrame(lane),
                            errorText(figures.at(lane, relmseOf, seconds)),
                            ratioText(figures.at(lane, relmseOf, seconds), figures.at(pt(true), relmseOf, seconds)),
                            ratioText(figures.at(lane, mseOf, seconds), figures.at(pt(true), mseOf, seconds)),
                            ratioText(figures.at(lane, chromaOf, seconds), figures.at(pt(true), chromaOf, seconds)),
                            number(passes::finiteMedian(figures.linearAt(lane, psnrOf, seconds)), "{:.2f}"),
                            number(passes::finiteMedian(figures.linearAt(lane, ssimOf, seconds)), "{:.3f}"),
                            number(passes::finiteMedian(figures.linearAt(lane, flipOf, seconds)), "{:.3f}"),
                            missed > 0 ? fmt::format("{} ({} of {} repeats did not)",
                                                     number(passes::finiteMedian(times)), missed, times.size())
                                       : number(passes::finiteMedian(times)),
                            meanText(figures.slopes(lane, relmseOf))});
        }
        page.table({"method", "frames", "ms/frame", "relative MSE", "to pt", "MSE to pt", "chroma MSE to pt", "PSNR dB",
                    "SSIM", "FLIP", fmt::format("s to {:.3g}", error), "slope"},
                   rows);
        page.paragraph(fmt::format(
            "Medians over {} repeats, 95% intervals in brackets. \"to pt\": the error divided by that of pt "
            "accumulating "
            "for the same time; above 1 pt is better. \"s to {:.3g}\": seconds until the relative MSE is down to what "
            "every method reaches. Slope: of log error against log time over the last decade; -1 is what averaging "
            "independent frames gives, 0 a plateau.",
            figures.repeats(), error));
    }

    void singlesTable(Page& page) const
    {
        page.heading(report.moving ? fmt::format("The last of {} frames of a moving camera", frames)
                                   : fmt::format("Single frames, after {} of them", frames));
        std::vector<std::vector<std::string>> rows;
        for (const Lane lane : singles) {
            const Values errors = figures.after(lane, relmseOf, frames);
            rows.push_back({nameOf(lane), millisecondsPerFrame(lane), errorText(errors),
                            ratioText(errors, figures.after(pt(false), relmseOf, frames)),
                            ratioText(errors, pathTracerInTimeOf(lane, relmseOf)),
                            ratioText(figures.after(lane, mseOf, frames), pathTracerInTimeOf(lane, mseOf)),
                            ratioText(figures.after(lane, lumaOf, frames), pathTracerInTimeOf(lane, lumaOf)),
                            ratioText(figures.after(lane, chromaOf, frames), pathTracerInTimeOf(lane, chromaOf)),
                            number(passes::finiteMedian(figures.after(lane, psnrOf, frames)), "{:.2f}"),
                            number(passes::finiteMedian(figures.after(lane, ssimOf, frames)), "{:.3f}"),
                            number(passes::finiteMedian(figures.after(lane, flipOf, frames)), "{:.3f}")});
        }
        page.table({"method", "ms/frame", "relative MSE", "to a frame of pt", "to pt, same time", "MSE, same time",
                    "luma MSE, same time", "chroma MSE, same time", "PSNR dB", "SSIM", "FLIP"},
                   rows);
        page.paragraph(
            report.moving
                ? "\"Same time\": the error divided by that of the path tracer with as many samples a pixel as "
                  "fit into the time of one frame of the method (its error is its frame's divided by that "
                  "number, exactly so for independent samples); above 1 pt is better."
                : "\"Same time\": the error divided by that of pt accumulating for as long as all these frames "
                  "took; above 1 pt is better. With a resting camera that is what a single frame competes with.");
    }

    std::vector<std::string> verdicts() const
    {
        const char* figure = "relative MSE";
        std::vector<std::string> sentences;
        const auto add = [&](const std::string& where, const auto& errorsOf) {
            std::vector<statistics::Contender> contenders;
            for (uint32_t method = 0; method < report.methods.size(); ++method)
                contenders.push_back({report.methods[method].name, errorsOf(method)});
            sentences.push_back(statistics::verdict(contenders, figure, where));
        };
        if (figures.repeats() == 0) return {"No repeat was measured, so nothing can be said."};
        if (!report.moving)
            add(fmt::format("In {} with a resting camera, means of all frames, equal time ({:.3g} s each):",
                            report.scene, seconds),
                [&](uint32_t method) {
                    return figures.at({method, true}, relmseOf, seconds);
                });
        if (frames == 0) return sentences;
        add(fmt::format("In {} with a {} camera, single frames after {} of them:", report.scene,
                        report.moving ? "moving" : "resting", frames),
            [&](uint32_t method) {
                return figures.after({method, false}, relmseOf, frames);
            });
        if (report.moving)
            add(fmt::format("In {} with a moving camera, equal time a frame (error times time: pt may trace more "
                            "samples):",
                            report.scene),
                [&](uint32_t method) {
                    const Lane lane{method, false};
                    return product(figures.after(lane, relmseOf, frames), figures.secondsAfter(lane, frames));
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

    void methodology(Page& page) const
    {
        page.heading("How it was measured");
        page.paragraph(fmt::format(
            "Methods took turns of a tenth of a second in rotating order after a warm-up, so that a busy machine "
            "treated "
            "all alike; {} repeats, each with random numbers of its own. Time is {}. Every comparison is within a "
            "repeat: "
            "intervals are Student's t on the logarithms of paired ratios, and where a verdict names several at once "
            "they "
            "hold together.",
            figures.repeats(),
            figures.deviceClock()
                ? "the device's own clock, summed over the method's frames (converge.csv also has wall time)"
                : "wall time of the method's turns: this device has no clock of its own"));
        page.paragraph(referenceText());
        page.paragraph(
            "Relative MSE: mean over pixels and channels of (x - r)² / (r² + 0.01). Chroma MSE: Co² + Cg² of "
            "the difference in YCoCg, luma MSE: Y². PSNR and SSIM: of c/(c+1) in linear RGB. FLIP: of c/(c+1) on "
            "an sRGB screen, 67 pixels per degree (Andersson et al. 2020).");
        uint64_t nonFinite = 0;
        for (const passes::Repeat& repeat : report.repeats) nonFinite += repeat.nonFinite;
        page.paragraph(fmt::format("Values that were not finite, all methods and repeats: {}.", nonFinite));
        if (!report.moving)
            page.paragraph("With a resting camera, rays through the pixels' centers and no spatial reuse, rgb-restir "
                           "is progressive "
                           "accumulation, which pt "
                           "does more cheaply: it has to earn its cost with spatial reuse and motion.");
    }

    // The corner of the window, a quarter of the picture wide and high, where the methods err most.
    glm::uvec2 worstWindow(const image::Image& reference, glm::uvec2 size) const
    {
        double most = -1;
        glm::uvec2 corner(0);
        for (uint32_t y = 0; y + size.y <= reference.height; y += std::max(size.y / 4, 1u))
            for (uint32_t x = 0; x + size.x <= reference.width; x += std::max(size.x / 4, 1u)) {
                double sum = 0;
                for (const image::Image& picture : report.pictures)
                    for (uint32_t j = y; j < y + size.y; ++j)
                        for (uint32_t i = x; i < x + size.x; ++i) {
                            const glm::dvec3 r(reference.at(i, j)), d = glm::dvec3(picture.at(i, j)) - r;
                            for (int c = 0; c < 3; ++c) // bounded, so that one bright pixel does not decide
                                sum += std::min(d[c] * d[c] / (r[c] * r[c] + image::RELATIVE_EPSILON), 1.0);
                        }
                if (sum <= most) continue;
                most = sum;
                corner = {x, y};
            }
        return corner;
    }

    void pictures(Page& page) const
    {
        if (report.pictures.size() != report.methods.size() || report.references.empty()) return;
        const image::Image& reference = report.references.rbegin()->second.picture;
        const glm::uvec2 size(std::max(reference.width / 4, 1u), std::max(reference.height / 4, 1u));
        const glm::uvec2 corner = worstWindow(reference, size);
        page.heading("Pictures");
        page.paragraph(report.moving
                           ? "The last frame of each method in the first repeat, and the part where they err "
                             "most; shown as c/(c+1)."
                           : "What each method had at its end in the first repeat, the mean of its frames, and "
                             "the part where they err most; shown as c/(c+1).");
        std::string html = "<div style=\"display:grid;grid-template-columns:2fr 1fr;gap:.5rem 1rem\">\n";
        const auto add = [&](const image::Image& picture, const std::string& caption) {
            image::Image crop{.width = size.x, .height = size.y};
            for (uint32_t y = 0; y < size.y; ++y)
                for (uint32_t x = 0; x < size.x; ++x) crop.pixels.push_back(picture.at(corner.x + x, corner.y + y));
            for (const image::Image* image : {&picture, static_cast<const image::Image*>(&crop)})
                html += fmt::format("<figure><img src=\"{}\" alt=\"{}\" style=\"width:100%;image-rendering:pixelated\">"
                                    "<figcaption>{}</figcaption></figure>\n",
                                    pngAddress(image::tonemappedPng(*image, {})), escapeHtml(caption),
                                    escapeHtml(image == &crop ? "detail" : caption));
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
        page.raw(html + "</div>\n");
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
    Page page("Error against run time: " + report.scene);
    for (const std::string& sentence : writer.verdicts()) page.verdict(sentence);
    page.provenance(report.provenance);
    if (writer.figures.repeats() > 0) {
        if (!report.moving) writer.meansTable(page);
        if (writer.frames > 0) writer.singlesTable(page);
    }
    page.heading("Curves");
    if (plots.empty()) page.paragraph("No curves: gnuplot is not installed (Debian package gnuplot-nox).");
    for (const NamedPlot& plot : plots) page.plot(plot.svg, plot.caption);
    writer.pictures(page);
    writer.methodology(page);
    return page.html();
}

} // namespace ui
