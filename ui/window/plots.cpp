#include "ui/window/plots.h"

#include <algorithm>
#include <cmath>

namespace ui
{

namespace
{

struct Figure {
    const char* name;
    const char* format;
    double (*of)(const image::Metrics&);
    bool plotted; // falls towards 0, so that a logarithm makes sense
};
constexpr Figure FIGURES[] = {
    {"relMSE", "{:.3g}", [](const image::Metrics& m) { return m.relmse; }, true},
    {"MSE", "{:.3g}", [](const image::Metrics& m) { return m.mse; }, true},
    {"MAPE", "{:.3g}", [](const image::Metrics& m) { return m.mape; }, true},
    {"luma MSE", "{:.3g}", [](const image::Metrics& m) { return m.lumaMse; }, true},
    {"chroma MSE", "{:.3g}", [](const image::Metrics& m) { return m.chromaMse; }, true},
    {"PSNR, dB", "{:.2f}", [](const image::Metrics& m) { return m.psnr; }, false},
    {"FLIP", "{:.4f}", [](const image::Metrics& m) { return m.flip; }, false},
    {"SSIM", "{:.4f}", [](const image::Metrics& m) { return m.ssim; }, false},
    {"mean R", "{:.4f}", [](const image::Metrics& m) { return m.meanRatio.r; }, false},
    {"mean G", "{:.4f}", [](const image::Metrics& m) { return m.meanRatio.g; }, false},
    {"mean B", "{:.4f}", [](const image::Metrics& m) { return m.meanRatio.b; }, false},
};
constexpr int PLOTTED = 5;

struct Range { // of logarithms to base 10
    double low = 1e30, high = -1e30;
    void add(double value)
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
    double at(double value) const { return (std::log10(value) - low) / (high - low); }
};

// Error at a time that a curve reached, between its points; 0 when it did not.
double errorAt(const ErrorCurve& curve, double seconds, const Figure& figure)
{
    for (size_t i = 1; i < curve.size(); ++i) {
        const ErrorPoint &a = curve[i - 1], &b = curve[i];
        if (seconds < a.seconds || seconds > b.seconds) continue;
        const double t = b.seconds > a.seconds ? std::log(seconds / a.seconds) / std::log(b.seconds / a.seconds) : 0;
        return std::exp((1 - t) * std::log(figure.of(a.metrics)) + t * std::log(figure.of(b.metrics)));
    }
    return 0;
}

void drawAxes(ImDrawList& list, const Range& x, const Range& y, ImVec2 low, ImVec2 high)
{
    const ImU32 faint = IM_COL32(255, 255, 255, 38), words = IM_COL32(170, 170, 175, 255);
    list.AddRectFilled(low, high, IM_COL32(12, 12, 14, 255));
    for (int decade = int(std::ceil(x.low)); decade <= x.high; ++decade) {
        const float at = low.x + float((decade - x.low) / (x.high - x.low)) * (high.x - low.x);
        list.AddLine({at, low.y}, {at, high.y}, faint);
        list.AddText({at + 2, high.y + 2}, words, fmt::format("{:g} s", std::pow(10.0, decade)).c_str());
    }
    for (int decade = int(std::ceil(y.low)); decade <= y.high; ++decade) {
        const float at = high.y - float((decade - y.low) / (y.high - y.low)) * (high.y - low.y);
        list.AddLine({low.x, at}, {high.x, at}, faint);
        list.AddText({low.x + 3, at - ImGui::GetTextLineHeight()}, words, fmt::format("1e{}", decade).c_str());
    }
    list.AddRect(low, high, IM_COL32(255, 255, 255, 80));
}

void drawCurve(ImDrawList& list, const ErrorCurve& curve, const Figure& figure, const Range& x, const Range& y,
               ImVec2 low, ImVec2 high, ImU32 color, float scale)
{
    std::vector<ImVec2> points;
    for (const ErrorPoint& point : curve) {
        const double error = figure.of(point.metrics);
        if (!(error > 0) || !(point.seconds > 0)) continue;
        points.emplace_back(low.x + float(x.at(point.seconds)) * (high.x - low.x),
                            high.y - float(y.at(error)) * (high.y - low.y));
    }
    list.AddPolyline(points.data(), int(points.size()), color, ImDrawFlags_None, 1.5f * scale);
    if (!points.empty()) list.AddCircleFilled(points.back(), 3 * scale, color);
}

void drawFigures(const ErrorCurve (&curves)[SIDES])
{
    if (!ImGui::BeginTable("figures", 3, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) return;
    const auto row = [&](const char* name, auto&& text) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextColored(colors::GRAY, "%s", name);
        for (const Side side : {A, B}) {
            ImGui::TableNextColumn();
            if (!curves[side].empty())
                ImGui::TextColored(colors::SIDES[side], "%s", text(curves[side].back(), side).c_str());
        }
    };
    row("", [](const ErrorPoint&, Side side) { return std::string(side == A ? "A" : "B"); });
    row("time", [](const ErrorPoint& point, Side) { return fmt::format("{:.1f} s", point.seconds); });
    row("frames", [](const ErrorPoint& point, Side) { return fmt::format("{}", point.frames); });
    for (const Figure& figure : FIGURES)
        row(figure.name, [&](const ErrorPoint& point, Side) {
            return fmt::format(fmt::runtime(figure.format), figure.of(point.metrics));
        });
    ImGui::EndTable();
}

} // namespace

void drawErrorPlot(WindowState& state, const ErrorMeter& meter)
{
    if (!state.plots) return;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const ImVec2 wanted = {std::min(660 * state.scale, screen.x - 20), std::min(320 * state.scale, screen.y - 20)};
    ImGui::SetNextWindowSize(wanted, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowPos({screen.x - wanted.x - 10, screen.y - wanted.y - 10}, ImGuiCond_FirstUseEver);
    if (!ImGui::Begin("Error against the reference", &state.plots, ImGuiWindowFlags_NoFocusOnAppearing)) {
        ImGui::End();
        return;
    }
    const ErrorCurve curves[SIDES] = {meter.curve(A), meter.curve(B)};
    static int plotted = 0;
    if (const std::string complaint = meter.complaint(); !complaint.empty()) {
        ImGui::PushTextWrapPos();
        ImGui::TextColored(colors::AMBER, "%s", complaint.c_str());
        ImGui::PopTextWrapPos();
    } else if (!state.pictures.reference) {
        ImGui::TextUnformatted("No reference yet: freeze a picture (F), or drop an EXR or PNG into the window.");
    } else {
        for (int i = 0; i < PLOTTED; ++i) {
            if (i > 0) ImGui::SameLine();
            ImGui::RadioButton(FIGURES[i].name, &plotted, i);
        }
    }
    const Figure& figure = FIGURES[plotted];
    Range x, y;
    for (const ErrorCurve& curve : curves)
        for (const ErrorPoint& point : curve) x.add(point.seconds), y.add(figure.of(point.metrics));
    x.widen(1);
    y.widen(1);
    const float table = 15 * ImGui::GetFontSize();
    const ImVec2 low = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    const ImVec2 high = {low.x + room.x - table, low.y + room.y - 2.6f * ImGui::GetTextLineHeight()};
    if (high.x > low.x + 40 && high.y > low.y + 40) {
        ImDrawList& list = *ImGui::GetWindowDrawList();
        drawAxes(list, x, y, low, high);
        list.PushClipRect(low, high, true);
        for (const Side side : {A, B})
            drawCurve(list, curves[side], figure, x, y, low, high, ImGui::ColorConvertFloat4ToU32(colors::SIDES[side]),
                      state.scale);
        list.PopClipRect();
        std::string equal = "time is that of rendering alone";
        if (!curves[A].empty() && !curves[B].empty()) {
            const double seconds = std::min(curves[A].back().seconds, curves[B].back().seconds);
            const double a = errorAt(curves[A], seconds, figure), b = errorAt(curves[B], seconds, figure);
            if (a > 0 && b > 0)
                equal = fmt::format("after {:.1f} s each: {} of B / A = {:.3g}", seconds, figure.name, b / a);
        }
        list.AddText({low.x, high.y + 1.3f * ImGui::GetTextLineHeight()}, IM_COL32(220, 220, 225, 255), equal.c_str());
    }
    ImGui::SetCursorScreenPos({low.x + room.x - table + 10, low.y});
    ImGui::BeginChild("beside", {0, 0});
    drawFigures(curves);
    ImGui::EndChild();
    ImGui::End();
}

} // namespace ui
