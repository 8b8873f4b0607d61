// The table and the plots of `converge`.

#include "ui/report/converge_page.h"

#include "engine/base/csv.h"
#include "ui/report/plot.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

namespace ui
{

namespace
{

constexpr size_t LEAST_FOR_INTERVALS = 4; // with fewer repeats intervals are as large as the plot

struct Curves {
    const ConvergeReport& report;
    passes::RaceFigures figures{report.repeats};

    // Geometric means over repeats, against median seconds or frames.
    Series series(passes::Lane lane, passes::Figure figure, bool bySeconds) const
    {
        Series series{.name = report.methods[lane.method].name, .color = int(lane.method)};
        const bool intervals = figures.repeats() >= LEAST_FOR_INTERVALS;
        for (const uint64_t frames : figures.framesOf(lane)) {
            const std::vector<double> errors = figures.after(lane, figure, frames);
            if (!passes::allAboveZero(errors)) continue;
            const statistics::Factor mean = statistics::factorOf(errors);
            series.x.push_back(bySeconds ? statistics::median(figures.secondsAfter(lane, frames)) : double(frames));
            series.y.push_back(mean.value);
            if (!intervals) continue;
            series.low.push_back(mean.interval.low);
            series.high.push_back(mean.interval.high);
        }
        return series;
    }

    std::vector<Series> all(bool average, passes::Figure figure, bool bySeconds) const
    {
        std::vector<Series> list;
        for (uint32_t method = 0; method < report.methods.size(); ++method)
            list.push_back(series({method, average}, figure, bySeconds));
        return list;
    }

    // What independent averaging would do from the path tracer's first point on.
    Series law(const Series& from, const char* name) const
    {
        if (from.x.empty()) return {};
        return {.name = name,
                .mark = Series::Mark::Dashed,
                .color = 6,
                .x = {from.x.front(), from.x.back()},
                .y = {from.y.front(), from.y.front() * from.x.front() / from.x.back()}};
    }

    // The path tracer with as many samples as fit into the time of each method's frame.
    std::vector<Series> pathTracerInTimeOf(passes::Figure figure) const
    {
        std::vector<Series> list;
        const passes::Lane pt{report.pt, false};
        for (uint32_t method = 0; method < report.methods.size(); ++method) {
            if (method == report.pt) continue;
            const passes::Lane lane{method, false};
            Series series{.name = "pt in time of " + report.methods[method].name,
                          .mark = Series::Mark::Dashed,
                          .color = int(method)};
            for (const uint64_t frames : figures.framesOf(lane)) {
                const std::vector<double> errors = figures.inTimeOf(lane, pt, figure, frames);
                if (!passes::allAboveZero(errors)) continue;
                series.x.push_back(double(frames));
                series.y.push_back(statistics::factorOf(errors).value);
            }
            list.push_back(std::move(series));
        }
        return list;
    }
};

} // namespace

std::string convergeCsv(const ConvergeReport& report)
{
    Csv csv({"scene", "method",  "shift", "max_confidence", "repeat",  "frames",         "seconds",
             "mse",   "relmse",  "psnr",  "ssim",           "flip",    "chroma_mse",     "luma_mse",
             "mape",  "average", "name",  "temporal",       "spatial", "device_seconds", "wall_seconds"});
    const passes::RaceFigures figures(report.repeats);
    for (size_t repeat = 0; repeat < report.repeats.size(); ++repeat)
        for (const passes::Sample& s : report.repeats[repeat].samples) {
            const passes::NamedMethod& method = report.methods[s.method];
            const auto texts = passes::toText(method.settings);
            const std::map<std::string, std::string> setting(texts.begin(), texts.end());
            csv.row({report.scene,
                     setting.at("method"),
                     setting.at("shift"),
                     setting.at("max-confidence"),
                     std::to_string(repeat),
                     std::to_string(s.frames),
                     csvNumber(figures.seconds(s)),
                     csvNumber(s.error.mse),
                     csvNumber(s.error.relmse),
                     csvNumber(s.error.psnr),
                     csvNumber(s.error.ssim),
                     csvNumber(s.error.flip),
                     csvNumber(s.error.chromaMse),
                     csvNumber(s.error.lumaMse),
                     csvNumber(s.error.mape),
                     s.average ? "on" : "off",
                     method.name,
                     setting.at("temporal"),
                     setting.at("spatial"),
                     csvNumber(s.deviceSeconds),
                     csvNumber(s.wallSeconds)});
        }
    return csv.text();
}

std::vector<NamedPlot> convergePlots(const ConvergeReport& report)
{
    const Curves curves{report};
    const std::string seconds = curves.figures.deviceClock() ? "device time (s)" : "wall time (s)";
    const std::string bars =
        curves.figures.repeats() >= LEAST_FOR_INTERVALS ? " Bars: 95% intervals over repeats." : "";
    std::vector<NamedPlot> plots;
    const auto add = [&](const std::string& file, const std::string& caption, Plot plot) {
        plot.logX = plot.logY = true;
        plot.title = report.scene + ": " + plot.title;
        if (const std::optional<std::string> svg = drawSvg(plot)) plots.push_back({file, caption + bars, *svg});
    };
    if (report.moving) {
        std::vector<Series> frames = curves.all(false, passes::RELMSE, false);
        std::ranges::move(curves.pathTracerInTimeOf(passes::RELMSE), std::back_inserter(frames));
        add("relmse-frames.svg",
            "Error of single frames while the camera moves. Dashed: the path tracer with as many samples a pixel as "
            "fit "
            "into the time of that method's frame.",
            {.title = "error of the last frame", .xLabel = "frames", .yLabel = "relative MSE", .series = frames});
        std::vector<Series> chroma = curves.all(false, passes::CHROMA_MSE, false);
        std::ranges::move(curves.pathTracerInTimeOf(passes::CHROMA_MSE), std::back_inserter(chroma));
        add("chroma-frames.svg", "Color noise of the same frames.",
            {.title = "chroma error of the last frame", .xLabel = "frames", .yLabel = "chroma MSE", .series = chroma});
        add("relmse-seconds.svg", "The same frames against the time that all frames so far took.",
            {.title = "error of the last frame",
             .xLabel = seconds,
             .yLabel = "relative MSE",
             .series = curves.all(false, passes::RELMSE, true)});
        return plots;
    }
    struct ByTime {
        const char *file, *name;
        passes::Figure figure;
    };
    for (const auto& [file, name, figure] :
         {ByTime{"relmse-seconds.svg", "relative MSE", passes::RELMSE}, ByTime{"mse-seconds.svg", "MSE", passes::MSE},
          ByTime{"chroma-seconds.svg", "chroma MSE", passes::CHROMA_MSE}}) {
        std::vector<Series> list = curves.all(true, figure, true);
        list.push_back(curves.law(list[report.pt], "slope -1"));
        add(file, fmt::format("{} of the mean of all frames against time: lower is better.", name),
            {.title = "error against time", .xLabel = seconds, .yLabel = name, .series = list});
    }
    std::vector<Series> list = curves.all(true, passes::RELMSE, false);
    for (Series& series : list) series.name += ", mean";
    for (Series single : curves.all(false, passes::RELMSE, false)) {
        single.mark = Series::Mark::Dashed;
        single.low.clear();
        single.high.clear();
        single.name += ", single";
        list.push_back(std::move(single));
    }
    add("relmse-frames.svg",
        "The same against frames, and dashed the error of single frames: what one sees before anything is averaged. "
        "Where "
        "a mean runs level, its frames are correlated.",
        {.title = "error against frames", .xLabel = "frames", .yLabel = "relative MSE", .series = list});
    return plots;
}

} // namespace ui
