#include "ui/window/plots.h"

#include "ui/window/axes.h"

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

void drawCurve(ImDrawList& list, const Axes& axes, const ErrorCurve& curve, const Figure& figure, ImU32 color,
               float scale)
{
    std::vector<ImVec2> points;
    for (const ErrorPoint& point : curve) {
        const double error = figure.of(point.metrics);
        if (!(error > 0) || !(point.seconds > 0)) continue;
        points.push_back(axes.at(point.seconds, error));
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
        ImGui::TextUnformatted(state.order.studies.reference
                                   ? "The reference begins to converge."
                                   : "No reference yet: freeze a picture (F), converge one, or drop an EXR or PNG.");
    } else {
        for (int i = 0; i < PLOTTED; ++i) {
            if (i > 0) ImGui::SameLine();
            ImGui::RadioButton(FIGURES[i].name, &plotted, i);
        }
    }
    const Figure& figure = FIGURES[plotted];
    Axes axes;
    for (const ErrorCurve& curve : curves)
        for (const ErrorPoint& point : curve) axes.x.add(point.seconds), axes.y.add(figure.of(point.metrics));
    axes.x.widen(1);
    axes.y.widen(1);
    const float table = 15 * ImGui::GetFontSize();
    const ImVec2 low = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    const ImVec2 high = {low.x + room.x - table, low.y + room.y - 2.6f * ImGui::GetTextLineHeight()};
    if (high.x > low.x + 40 && high.y > low.y + 40) {
        ImDrawList& list = *ImGui::GetWindowDrawList();
        axes.low = low;
        axes.high = high;
        axes.draw(list, " s");
        list.PushClipRect(low, high, true);
        for (const Side side : {A, B})
            drawCurve(list, axes, curves[side], figure, ImGui::ColorConvertFloat4ToU32(colors::SIDES[side]),
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
