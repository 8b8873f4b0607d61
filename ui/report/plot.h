#pragma once
// Plots for reports, drawn by gnuplot.

#include <optional>
#include <string>
#include <vector>

namespace ui
{

struct Series {
    enum class Mark { Line, Dashed, Points, LinePoints };
    std::string name;
    Mark mark = Mark::LinePoints;
    int color = 0;                 // equal numbers, equal colors: 0, 1, 2, ...
    std::vector<double> x, y;      // as many of each
    std::vector<double> low, high; // an interval around each y; empty: none
};

struct Plot {
    std::string title, xLabel, yLabel; // with units
    bool logX = false, logY = false;   // values that are not above 0 are left out of such an axis
    std::vector<Series> series;
};

// The gnuplot program that draws the plot to its standard output, data included.
std::string gnuplotScript(const Plot& plot);

// SVG; nothing when gnuplot is not installed. Throws Error when gnuplot fails.
std::optional<std::string> drawSvg(const Plot& plot);

} // namespace ui
