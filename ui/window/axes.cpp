#include "ui/window/axes.h"

#include <fmt/format.h>

namespace ui
{

void Axes::draw(ImDrawList& list, const std::string& unit) const
{
    const ImU32 faint = IM_COL32(255, 255, 255, 38), words = IM_COL32(170, 170, 175, 255);
    list.AddRectFilled(low, high, IM_COL32(12, 12, 14, 255));
    for (int decade = int(std::ceil(x.low)); decade <= x.high; ++decade) {
        const float left = low.x + float((decade - x.low) / (x.high - x.low)) * (high.x - low.x);
        list.AddLine({left, low.y}, {left, high.y}, faint);
        list.AddText({left + 2, high.y + 2}, words, fmt::format("{:g}{}", std::pow(10.0, decade), unit).c_str());
    }
    for (int decade = int(std::ceil(y.low)); decade <= y.high; ++decade) {
        const float top = high.y - float((decade - y.low) / (y.high - y.low)) * (high.y - low.y);
        list.AddLine({low.x, top}, {high.x, top}, faint);
        list.AddText({low.x + 3, top - ImGui::GetTextLineHeight()}, words, fmt::format("1e{}", decade).c_str());
    }
    list.AddRect(low, high, IM_COL32(255, 255, 255, 80));
}

} // namespace ui
