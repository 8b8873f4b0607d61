#include "ui/window/axes.h"

#include <vector>

#include <fmt/format.h>

namespace ui
{

namespace
{

// Powers of ten, and 2 and 5 times them where those are few.
std::vector<double> marksOf(const LogRange& range)
{
    const bool few = range.high - range.low < 2;
    std::vector<double> marks;
    for (int decade = int(std::floor(range.low)); decade <= range.high; ++decade)
        for (const double digit : {1.0, 2.0, 5.0}) {
            const double mark = digit * std::pow(10.0, decade), place = range.at(mark);
            if ((digit == 1 || few) && place >= 0 && place <= 1) marks.push_back(mark);
        }
    return marks;
}

} // namespace

void Axes::draw(ImDrawList& list, const std::string& unit) const
{
    const ImU32 faint = IM_COL32(255, 255, 255, 38), words = IM_COL32(170, 170, 175, 255);
    list.AddRectFilled(low, high, IM_COL32(12, 12, 14, 255));
    for (const double mark : marksOf(x)) {
        const float left = low.x + float(x.at(mark)) * (high.x - low.x);
        list.AddLine({left, low.y}, {left, high.y}, faint);
        list.AddText({left + 2, high.y + 2}, words, fmt::format("{:g}{}", mark, unit).c_str());
    }
    for (const double mark : marksOf(y)) {
        const float top = high.y - float(y.at(mark)) * (high.y - low.y);
        list.AddLine({low.x, top}, {high.x, top}, faint);
        list.AddText({low.x + 3, std::max(top - ImGui::GetTextLineHeight(), low.y)}, words,
                     fmt::format("{:g}", mark).c_str());
    }
    list.AddRect(low, high, IM_COL32(255, 255, 255, 80));
}

} // namespace ui
