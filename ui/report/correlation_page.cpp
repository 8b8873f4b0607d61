#include "ui/report/correlation_page.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "engine/base/files.h"
#include "engine/image/image.h"
#include "ui/cli/output_file.h"
#include "ui/report/plot.h"

namespace ui
{

namespace
{

using Json = nlohmann::json;
using passes::Correlation;
using passes::Curve;
using passes::CurvePoint;
using statistics::Estimate;

constexpr uint32_t MAP_WIDTH = 480; // pixels on the page, at least
constexpr double BRIGHT = 0.98;     // this part of a map's values lies below 1

std::string text(double value)
{
    return fmt::format("{:.4g}", value);
}

std::string intervalText(const Estimate& estimate)
{
    const statistics::Interval i = statistics::meanInterval(estimate);
    return fmt::format("{:.3g} to {:.3g}", i.low, i.high);
}

const CurvePoint* lastMeasured(const Curve& curve)
{
    const auto point = std::ranges::find_if(curve.points.rbegin(), curve.points.rend(),
                                            [](const CurvePoint& p) { return p.runs > 0; });
    return point == curve.points.rend() ? nullptr : &*point;
}

// a / b with an interval to first order in logarithms; both of independent estimates (of the same trees, which makes
// the true interval narrower if anything).
std::string ratioText(const Estimate& a, const Estimate& b)
{
    const double spread = std::sqrt(a.varianceOfMean / (a.mean * a.mean) + b.varianceOfMean / (b.mean * b.mean));
    const double factor =
        std::exp(statistics::studentQuantile(0.975, std::min(a.degreesOfFreedom, b.degreesOfFreedom)) * spread);
    const double ratio = a.mean / b.mean;
    return fmt::format("{:.3g} times ({:.3g} to {:.3g})", ratio, ratio / factor, ratio * factor);
}

// A value of a curve: at which M or lag, as far as it is measured, and as far as it is predicted.
struct Mark {
    double x;
    std::optional<Estimate> measured, law;
};

Plot plotOf(Plot plot, const Correlation& correlation, const std::function<std::vector<Mark>(const Curve&)>& marksOf)
{
    plot.logX = plot.logY = true;
    int color = 0;
    for (const Curve& curve : correlation.curves) {
        Series measured{.name = curve.method.name, .mark = Series::Mark::LinePoints, .color = color};
        Series law{.name = curve.method.name + ", law", .mark = Series::Mark::Dashed, .color = color};
        for (const Mark& mark : marksOf(curve)) {
            if (mark.measured) {
                const statistics::Interval interval = statistics::meanInterval(*mark.measured);
                measured.x.push_back(mark.x);
                measured.y.push_back(mark.measured->mean);
                measured.low.push_back(interval.low);
                measured.high.push_back(interval.high);
            }
            if (mark.law) {
                law.x.push_back(mark.x);
                law.y.push_back(mark.law->mean);
            }
        }
        if (!law.x.empty()) measured.mark = Series::Mark::Points;
        if (!measured.x.empty() || !law.x.empty()) plot.series.push_back(std::move(measured));
        if (!law.x.empty()) plot.series.push_back(std::move(law));
        ++color;
    }
    return plot;
}

std::vector<Mark> marksByFrame(const Curve& curve)
{
    std::vector<Mark> marks;
    for (const CurvePoint& point : curve.points)
        marks.push_back(
            {double(point.frame), point.runs > 0 ? std::optional(point.autocovariance) : std::nullopt, point.law});
    return marks;
}

std::vector<Mark> marksByLag(const Curve& curve)
{
    const CurvePoint* last = lastMeasured(curve);
    if (last == nullptr) return {};
    std::vector<Mark> marks = {{1, last->autocovariance, last->law}};
    for (const passes::LagEstimate& lag : last->lags) marks.push_back({double(lag.lag), lag.autocovariance, lag.law});
    return marks;
}

std::vector<Mark> marksOfFilm(const Curve& curve)
{
    std::vector<Mark> marks;
    for (const CurvePoint& point : curve.points)
        if (point.film) marks.push_back({double(point.frame), point.film, point.filmLaw});
    return marks;
}

// Draws what there is to draw, writes the files, and says what the page shows. Nothing without gnuplot.
Json plotsOf(const Correlation& correlation, const std::filesystem::path& directory)
{
    const std::string law = "Dashed: what the law predicts from single frames.";
    struct Figure {
        const char* file;
        Plot plot;
        std::string caption;
    };
    const Figure figures[] = {
        {"autocovariance.svg",
         plotOf({.title = "Autocovariance between the frames M-1 and M: " + correlation.scene,
                 .xLabel = "M (frames; M_c >= M)",
                 .yLabel = "autocovariance (radiance^2)"},
                correlation, marksByFrame),
         "Points: measured, with 95% intervals. " + law},
        {"lags.svg",
         plotOf({.title = "Autocovariance between frames that lie further apart: " + correlation.scene,
                 .xLabel = "lag (frames before the last one measured)",
                 .yLabel = "autocovariance (radiance^2)"},
                correlation, marksByLag),
         "How long a frame is remembered, at the largest M that was measured. " + law},
        {"film.svg",
         plotOf({.title = "Variance of the mean of the frames 1 to M: " + correlation.scene,
                 .xLabel = "M (frames; M_c >= M)",
                 .yLabel = "variance (radiance^2)"},
                correlation, marksOfFilm),
         "Does the film's mean converge? Samples that stay leave half their plateau in it. " + law},
    };
    Json list = Json::array();
    for (const Figure& figure : figures) {
        if (figure.plot.series.empty()) continue;
        const std::optional<std::string> svg = drawSvg(figure.plot);
        if (!svg) continue;
        writeText(directory / figure.file, *svg);
        list.push_back({{"svg", inlineSvg(*svg)}, {"caption", figure.caption}});
    }
    return list;
}

Json curvesOf(const Correlation& correlation)
{
    Json list = Json::array();
    for (const Curve& curve : correlation.curves) {
        std::string facts;
        if (correlation.sigma2)
            facts += fmt::format("Path tracer's variance per frame σ² = {} ({}). ", text(correlation.sigma2->mean),
                                 intervalText(*correlation.sigma2));
        if (curve.plateau && passes::accumulates(curve.method.settings))
            facts += "Plateau P = 0: every channel is estimated for itself. ";
        else if (curve.plateau)
            facts += fmt::format("Plateau P = {} ({}). ", text(curve.plateau->mean), intervalText(*curve.plateau));
        if (const auto cross = crossover(correlation, curve))
            facts += fmt::format("Crossover M* = σ²/P = {} ({:.3g} to {:.3g}). ",
                                 text(correlation.sigma2->mean / curve.plateau->mean), cross->low, cross->high);
        std::vector<std::vector<std::string>> rows;
        for (const CurvePoint& point : curve.points) {
            const bool measured = point.runs > 0;
            rows.push_back({std::to_string(point.frame), measured ? text(point.autocovariance.mean) : "–",
                            measured ? intervalText(point.autocovariance) : "–",
                            point.law ? text(point.law->mean) : "–",
                            std::isnan(point.z()) ? "–" : fmt::format("{:+.2f}", point.z()),
                            measured ? text(point.variance.mean) : "–",
                            measured ? fmt::format("{} x {}", point.runs, point.pixels) : "–"});
        }
        Json& section = list.emplace_back(tableData(
            {"M", "measured", "95% interval", "predicted", "z", "variance of frame M", "runs x pixels"}, rows));
        section["method"] = curve.method.name;
        section["facts"] = facts;
    }
    return list;
}

// Enlarged so that pixels can be seen, and scaled so that most of it lies within what a screen shows.
image::Image shown(const std::vector<glm::dvec3>& values, uint32_t width, uint32_t height)
{
    std::vector<double> sorted;
    for (const glm::dvec3& value : values) sorted.push_back(std::max({value.x, value.y, value.z}));
    std::ranges::sort(sorted);
    const double bright = sorted[size_t(BRIGHT * double(sorted.size() - 1))];
    const double scale = bright > 0 ? 1 / bright : 1;
    const uint32_t zoom = std::max(1u, (MAP_WIDTH + width - 1) / width);
    image::Image picture{.width = width * zoom, .height = height * zoom};
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x)
            picture.pixels.emplace_back(values[size_t{y / zoom} * width + x / zoom] * scale);
    return picture;
}

// With the files that it names, written into the directory.
Json floorsOf(const Correlation& correlation, const std::filesystem::path& directory)
{
    Json list = Json::array();
    for (const Curve& curve : correlation.curves) {
        if (curve.floor.empty() || passes::accumulates(curve.method.settings)) continue;
        std::string name = "color-noise-floor-";
        for (const char c : curve.method.name)
            name += std::isalnum(static_cast<unsigned char>(c)) || c == '-' ? c : '_';
        image::Image exr{.width = correlation.width, .height = correlation.height};
        std::vector<glm::dvec3> deviation;
        for (const glm::dvec3& value : curve.floor) {
            exr.pixels.emplace_back(value);
            deviation.push_back(glm::sqrt(glm::max(value, glm::dvec3(0)))); // an estimate of 0 may fall below
        }
        image::write(directory / (name + ".exr"), exr, {{"scene", correlation.scene}, {"method", curve.method.name}});
        const auto png = [&](const std::vector<glm::dvec3>& values) {
            return image::tonemappedPng(shown(values, correlation.width, correlation.height), {});
        };
        const std::vector<std::byte> map = png(deviation);
        files::writeAtomically(directory / (name + ".png"), map);
        list.push_back(
            {{"method", curve.method.name},
             {"file", name},
             {"maps",
              {{{"png", pngAddress(map)},
                {"caption", "√P, scaled so that 98% of the pixels lie below half brightness."}},
               {{"png", pngAddress(png(curve.mean))},
                {"caption",
                 "The picture itself, likewise: the mean of all frames, without what is seen directly."}}}}});
    }
    return list;
}

} // namespace

std::vector<std::string> verdictsOf(const Correlation& correlation)
{
    std::vector<std::string> sentences;
    const Curve* one = nullptr;  // a reservoir that channels share
    const Curve* each = nullptr; // channels that are estimated each for itself
    for (const Curve& curve : correlation.curves) {
        if (lastMeasured(curve) == nullptr) continue;
        const Curve*& which = passes::accumulates(curve.method.settings) ? each : one;
        if (which == nullptr) which = &curve;
    }
    if (one != nullptr && each != nullptr) {
        const CurvePoint *a = lastMeasured(*one), *b = lastMeasured(*each);
        if (a->frame != b->frame)
            sentences.push_back(fmt::format("{} is measured to M = {}, {} to M = {}.", one->method.name, a->frame,
                                            each->method.name, b->frame));
        else if (a->autocovariance.mean > 0 && b->autocovariance.mean > 0)
            sentences.push_back(fmt::format("At M = {}, frames of {} covary {} as much as those of {}: {} against {}.",
                                            a->frame, one->method.name, ratioText(a->autocovariance, b->autocovariance),
                                            each->method.name, text(a->autocovariance.mean),
                                            text(b->autocovariance.mean)));
    }
    if (one != nullptr && each != nullptr && one->points.back().law && each->points.back().law) {
        const CurvePoint &a = one->points.back(), &b = each->points.back();
        if (a.frame == b.frame && a.runs == 0)
            sentences.push_back(fmt::format("Predicted at M = {}: {} against {}, {}.", a.frame, text(a.law->mean),
                                            text(b.law->mean), ratioText(*a.law, *b.law)));
    }
    if (one != nullptr && one->plateau) {
        if (const auto cross = crossover(correlation, *one)) {
            const double at = correlation.sigma2->mean / one->plateau->mean;
            sentences.push_back(fmt::format(
                "The curves part around M* = σ²/P = {:.3g} ({:.3g} to {:.3g}): before, a reservoir for each "
                "channel gains little; a tenfold gap needs M of about 9 M* = {:.2g}.",
                at, cross->low, cross->high, 9 * at));
        } else {
            sentences.push_back("No plateau was found: here one reservoir is as good as several.");
        }
    }
    double worst = 0;
    int count = 0;
    for (const Curve& curve : correlation.curves)
        for (const CurvePoint& point : curve.points)
            if (const double z = point.z(); !std::isnan(z)) {
                worst = std::max(worst, std::abs(z));
                ++count;
            }
    if (count > 0)
        sentences.push_back(
            worst < 4
                ? fmt::format(
                      "Measured and predicted agree: of {} points none is further apart than {:.1f} standard errors.",
                      count, worst)
                : fmt::format(
                      "Measured and predicted DISAGREE: of {} points one is {:.1f} standard errors apart. "
                      "Rare bright paths in few runs would explain it (try more --runs on a smaller --size); else "
                      "something is wrong.",
                      count, worst));
    if (each != nullptr && passes::lawHolds(each->method.settings, correlation.sameView))
        sentences.push_back(fmt::format("In this regime (resting camera, temporal reuse alone) {} is progressive "
                                        "accumulation: frame M is the mean of the path tracer's first M frames, which "
                                        "a path tracer that adds up its frames gives for less time. It must earn its "
                                        "cost with spatial reuse and motion.",
                                        each->method.name));
    if (correlation.moving)
        sentences.push_back("The camera moves: figures follow surface points from frame to frame, and the law of the "
                            "resting camera says nothing about them.");
    else if (!correlation.sameView)
        sentences.push_back("Pixels see other points in each frame (rays anywhere through the pixel, or alpha-blended "
                            "surfaces), and the law of the resting camera says nothing about that.");
    if (sentences.empty()) sentences.push_back("Nothing was measured yet.");
    return sentences;
}

void writeCorrelation(const std::filesystem::path& directory, const Correlation& correlation,
                      const Provenance& provenance)
{
    writeText(directory / "correlate.csv", csvOf(correlation));
    writeText(directory / "index.html",
              fillPage("{{> correlate.html}}", {{"title", "Autocovariance: " + correlation.scene},
                                                {"verdicts", verdictsOf(correlation)},
                                                {"plots", plotsOf(correlation, directory)},
                                                {"provenance", provenanceData(provenance)},
                                                {"floors", floorsOf(correlation, directory)},
                                                {"curves", curvesOf(correlation)},
                                                {"width", std::to_string(correlation.width)},
                                                {"height", std::to_string(correlation.height)},
                                                {"runs", std::to_string(correlation.runs)},
                                                {"moving", correlation.moving},
                                                {"nonFinite", std::to_string(correlation.nonFinite)}}));
}

} // namespace ui
