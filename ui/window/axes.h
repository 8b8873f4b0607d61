#pragma once
// Two logarithmic axes, and where numbers lie between them.

#include <algorithm>
#include <cmath>
#include <string>

#include <imgui.h>

namespace ui
{

struct LogRange { // of logarithms to base 10
    double low = 1e30, high = -1e30;
    void add(double value) // what is not above 0 has no place
    {
        if (!(value > 0)) return;
        low = std::min(low, std::log10(value));
        high = std::max(high, std::log10(value));
    }
    void widen(double least)
    {
        if (low > high) low = high = 0;
        const double missing = std::max(least - (high - low), 0.0);
        low -= missing / 2;
        high += missing / 2;
    }
    double at(double value) const { return (std::log10(value) - low) / (high - low); } // 0 to 1
};

struct Axes {
    LogRange x, y;
    ImVec2 low, high; // corners on the screen

    ImVec2 at(double px, double py) const
    {
        return {low.x + float(x.at(px)) * (high.x - low.x), high.y - float(y.at(py)) * (high.y - low.y)};
    }
    // `unit` goes after the numbers of x.
    void draw(ImDrawList& list, const std::string& unit) const;
};

} // namespace ui
