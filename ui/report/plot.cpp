#include "ui/report/plot.h"

#include "engine/base/check.h"
#include "engine/base/error.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include <sys/wait.h>
#include <unistd.h>

namespace ui
{

namespace
{

constexpr int EXIT_NO_PROGRAM = 127; // as shells report it

// Distinct also for people who do not tell red from green (Okabe and Ito).
constexpr const char* COLORS[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};

std::string gnuplotText(const std::string& text)
{
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += c == '\n' ? ' ' : c;
    }
    return result + "\"";
}

std::string styleOf(const Series& series)
{
    const std::string color = fmt::format("lc rgb \"{}\"", COLORS[size_t(series.color) % std::size(COLORS)]);
    switch (series.mark) {
    case Series::Mark::Line: return "with lines lw 2 " + color;
    case Series::Mark::Dashed: return "with lines lw 1.5 dt 2 " + color;
    case Series::Mark::Points: return "with points pt 7 ps 0.6 " + color;
    case Series::Mark::LinePoints: return "with linespoints lw 1.5 pt 7 ps 0.5 " + color;
    }
    return {};
}

} // namespace

std::string gnuplotScript(const Plot& plot)
{
    std::string script =
        "set terminal svg size 860,520 dynamic font \"sans-serif,14\" background \"#ffffff\" noenhanced\n"
        "set key outside right top vertical noenhanced\nset grid lc rgb \"#d5dae3\"\n"
        "set format x \"%g\"\nset format y \"%g\"\n";
    script += "set title " + gnuplotText(plot.title) + "\nset xlabel " + gnuplotText(plot.xLabel) + "\nset ylabel " +
              gnuplotText(plot.yLabel) + "\n";
    if (plot.logX) script += "set logscale x\n";
    if (plot.logY) script += "set logscale y\n";

    std::string bars, curves; // gnuplot leaves a white spot below each bar: bars are drawn first
    for (size_t s = 0; s < plot.series.size(); ++s) {
        const Series& series = plot.series[s];
        const bool interval = !series.low.empty();
        CHECK_EQ(series.x.size(), series.y.size());
        if (interval) {
            CHECK_EQ(series.low.size(), series.y.size());
            CHECK_EQ(series.high.size(), series.y.size());
        }
        std::string rows;
        for (size_t i = 0; i < series.x.size(); ++i) {
            if ((plot.logX && !(series.x[i] > 0)) || (plot.logY && !(series.y[i] > 0))) continue;
            rows += fmt::format("{:.9g} {:.9g}", series.x[i], series.y[i]);
            if (interval) { // on a logarithmic axis an interval that reaches 0 is cut at the axis
                const double low = plot.logY && !(series.low[i] > 0) ? series.y[i] * 1e-3 : series.low[i];
                rows += fmt::format(" {:.9g} {:.9g}", low, series.high[i]);
            }
            rows += "\n";
        }
        if (rows.empty()) continue;
        script += fmt::format("$data{} << EOD\n{}EOD\n", s, rows);
        curves += fmt::format("$data{} using 1:2 {} title {}, ", s, styleOf(series), gnuplotText(series.name));
        if (interval)
            bars += fmt::format("$data{} using 1:2:3:4 with yerrorbars pt 0 lw 1 lc rgb \"{}\" notitle, ", s,
                                COLORS[size_t(series.color) % std::size(COLORS)]);
    }
    if (curves.empty()) return script + "set xrange [1:10]\nset yrange [1:10]\nplot NaN notitle\n";
    return script + "plot " + bars + curves + "\n"; // gnuplot allows the last comma
}

std::optional<std::string> drawSvg(const Plot& plot)
{
    // A file for the program, a pipe for the picture: neither side waits for the other.
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> script(std::tmpfile(), std::fclose);
    if (!script) throw Error("Cannot make a temporary file for gnuplot: {}.", std::strerror(errno));
    const std::string text = gnuplotScript(plot);
    if (std::fwrite(text.data(), 1, text.size(), script.get()) != text.size() || std::fflush(script.get()) != 0)
        throw Error("Cannot write a temporary file for gnuplot: {}.", std::strerror(errno));

    const std::string command = fmt::format("exec gnuplot /dev/fd/{} 2>&1", fileno(script.get()));
    std::FILE* const pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) throw Error("Cannot start gnuplot: {}.", std::strerror(errno));
    std::string svg;
    char part[4096];
    for (size_t count; (count = std::fread(part, 1, sizeof part, pipe)) > 0;) svg.append(part, count);
    const int status = pclose(pipe);
    if (WIFEXITED(status) && WEXITSTATUS(status) == EXIT_NO_PROGRAM) return std::nullopt;
    if (status != 0 || svg.find("</svg>") == std::string::npos)
        throw Error("gnuplot could not draw the plot \"{}\": {}", plot.title, svg.substr(0, 300));
    return svg.substr(svg.find("<?xml"));
}

} // namespace ui
