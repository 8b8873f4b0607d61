#include "ui/window/plots.h"

#include "engine/base/convergence.h"
#include "ui/window/axes.h"

#include <algorithm>
#include <optional>

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
    statistics::ErrorCurve points;
    for (const ErrorPoint& point : curve) {
        points.seconds.push_back(point.seconds);
        points.errors.push_back(figure.of(point.metrics));
    }
    return statistics::errorAt(points, seconds).value_or(0);
}

// What stands below the plot: B's error over A's after the same time, where both are known.
std::string atEqualTime(const ErrorCurve (&curves)[SIDES], const Figure& figure)
{
    const auto last = [](const ErrorCurve& curve) { return curve.empty() ? 0 : curve.back().seconds; };
    const double seconds = std::min(last(curves[A]), last(curves[B]));
    const double a = errorAt(curves[A], seconds, figure), b = errorAt(curves[B], seconds, figure);
    if (a > 0 && b > 0) return fmt::format("after {:.1f} s each: {} of B / A = {:.3g}", seconds, figure.name, b / a);
    return "time is that of rendering alone";
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

void drawCurve(ImDrawList& list, const Axes& axes, const passes::Curve& curve, ImU32 color, float scale)
{
    std::vector<ImVec2> measured;
    for (const passes::CurvePoint& point : curve.points) {
        if (!(point.autocovariance.mean > 0)) continue;
        const ImVec2 at = axes.at(point.frame, point.autocovariance.mean);
        measured.push_back(at);
        list.AddCircleFilled(at, 3 * scale, color);
        const statistics::Interval interval = statistics::meanInterval(point.autocovariance);
        if (interval.low > 0) // a bar without a lower end says little on a logarithm
            list.AddLine(axes.at(point.frame, interval.low), axes.at(point.frame, interval.high), color, scale);
    }
    list.AddPolyline(measured.data(), int(measured.size()), color, ImDrawFlags_None, 1.5f * scale);
    for (size_t i = 1; i < curve.points.size(); ++i) { // dashes: half of each piece
        const passes::CurvePoint &a = curve.points[i - 1], &b = curve.points[i];
        if (!a.law || !b.law || !(a.law->mean > 0) || !(b.law->mean > 0)) continue;
        const ImVec2 from = axes.at(a.frame, a.law->mean), to = axes.at(b.frame, b.law->mean);
        constexpr int DASHES = 6;
        for (int dash = 0; dash < DASHES; ++dash) {
            const float t = float(dash) / DASHES, u = (float(dash) + 0.5f) / DASHES;
            list.AddLine({from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)},
                         {from.x + u * (to.x - from.x), from.y + u * (to.y - from.y)}, IM_COL32(255, 255, 255, 150),
                         scale);
        }
    }
}

std::string sentenceOf(const WindowState& state, Side side)
{
    const char* name = side == A ? "A" : "B";
    const std::shared_ptr<const CorrelationCurve>& known = state.findings->curves[side];
    const passes::Settings settings = settingsOf(state.order, side);
    if (settings.method == passes::Method::Pt) return fmt::format("{}: the path tracer's frames are independent", name);
    if (!settings.temporal) return fmt::format("{}: reuse in time is off, so frames are independent", name);
    if (settings.maxConfidence < 2) return fmt::format("{}: M_c is 1, so there is no history", name);
    if (!known || known->curve.points.empty()) return fmt::format("{}: no point yet", name);
    const passes::Curve& curve = known->curve;
    std::string text = fmt::format("{}: {} x {} pixels, {} runs, {} batches done", name, known->width, known->height,
                                   known->runs, known->batches);
    if (curve.plateau) text += fmt::format("; levels off at P = {:.2g}", curve.plateau->mean);
    if (settings.spatial > 0)
        text += "; no law is known with reuse in space";
    else if (!curve.plateau && curve.points.size() > 1 && !passes::accumulates(settings))
        text += "; no law is known where pixels see other points in each frame";
    return text;
}

// Where the person has not put it yet, it has this size, or less on a small screen, and lies at the screen's right
// edge: `top` below its upper edge, or at the lower one where there is no `top` or no room below.
bool openPlot(const WindowState& state, const char* title, bool& open, ImVec2 size, std::optional<float> top = {})
{
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const ImVec2 wanted = {std::min(size.x * state.scale, screen.x - 20),
                           std::min(size.y * state.scale, screen.y - 20)};
    const float lowest = screen.y - wanted.y - 10, y = top ? std::min(*top * state.scale, lowest) : lowest;
    ImGui::SetNextWindowSize(wanted, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowPos({screen.x - wanted.x - 10, y}, ImGuiCond_FirstUseEver);
    return ImGui::Begin(title, &open, ImGuiWindowFlags_NoFocusOnAppearing);
}

// The axes and, between them, what `curves` draws; false where there is no room.
template <class Curves>
bool drawBetween(const Axes& axes, const char* unit, Curves&& curves)
{
    if (axes.high.x <= axes.low.x + 40 || axes.high.y <= axes.low.y + 40) return false;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    axes.draw(list, unit);
    list.PushClipRect(axes.low, axes.high, true);
    curves(list);
    list.PopClipRect();
    return true;
}

} // namespace

void drawErrorPlot(WindowState& state, const ErrorMeter& meter)
{
    if (!state.plots) return;
    if (!openPlot(state, "Error against the reference", state.plots, {660, 320})) {
        ImGui::End();
        return;
    }
    const ErrorCurve curves[SIDES] = {meter.curve(A), meter.curve(B)};
    static int plotted = 0;
    if (const std::string complaint = meter.complaint(); !complaint.empty()) {
        sentence(colors::AMBER, complaint);
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
    axes.low = low;
    axes.high = high;
    const bool fits = drawBetween(axes, " s", [&](ImDrawList& list) {
        for (const Side side : {A, B})
            drawCurve(list, axes, curves[side], figure, ImGui::ColorConvertFloat4ToU32(colors::SIDES[side]),
                      state.scale);
    });
    if (fits)
        ImGui::GetWindowDrawList()->AddText({low.x, high.y + 1.3f * ImGui::GetTextLineHeight()},
                                            IM_COL32(220, 220, 225, 255), atEqualTime(curves, figure).c_str());
    ImGui::SetCursorScreenPos({low.x + room.x - table + 10, low.y});
    ImGui::BeginChild("beside", {0, 0});
    drawFigures(curves);
    ImGui::EndChild();
    ImGui::End();
}

void drawCorrelationPlot(WindowState& state)
{
    if (!state.correlation) return;
    constexpr float TOP = 155; // between the pixel's window and the errors
    if (openPlot(state, "Autocovariance of the frames M-1 and M", state.correlation, {520, 225}, TOP)) {
        for (const Side side : {A, B}) {
            if (side == B && !state.order.rival) continue;
            sentence(colors::SIDES[side], sentenceOf(state, side));
        }
        ImGui::TextColored(colors::GRAY, "Solid: measured, with 95%% intervals. Dashed: predicted by the law.");
        Axes axes;
        for (const auto& known : state.findings->curves)
            for (size_t i = 0; known && i < known->curve.points.size(); ++i) {
                const passes::CurvePoint& point = known->curve.points[i];
                axes.x.add(point.frame);
                axes.y.add(point.autocovariance.mean);
                axes.y.add(point.law ? point.law->mean : 0);
            }
        axes.x.widen(1);
        axes.y.widen(1);
        const ImVec2 room = ImGui::GetContentRegionAvail();
        axes.low = ImGui::GetCursorScreenPos();
        axes.high = {axes.low.x + room.x, axes.low.y + room.y - 1.3f * ImGui::GetTextLineHeight()};
        drawBetween(axes, "", [&](ImDrawList& list) {
            for (const Side side : {A, B})
                if (const auto& known = state.findings->curves[side])
                    drawCurve(list, axes, known->curve, ImGui::ColorConvertFloat4ToU32(colors::SIDES[side]),
                              state.scale);
        });
    }
    ImGui::End();
}

} // namespace ui
