#include "ui/window/plots.h"

#include "ui/window/axes.h"

namespace ui
{

namespace
{

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
    else if (!curve.plateau && curve.points.size() > 1 && !passes::accumulates(settings.method))
        text += "; no law is known where pixels see other points in each frame";
    return text;
}

} // namespace

void drawCorrelationPlot(WindowState& state)
{
    if (!state.correlation) return;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const ImVec2 wanted = {std::min(520 * state.scale, screen.x - 20), std::min(225 * state.scale, screen.y - 20)};
    ImGui::SetNextWindowSize(wanted, ImGuiCond_FirstUseEver);
    const float top =
        std::min(155 * state.scale, screen.y - wanted.y - 10); // between the pixel's window and the errors
    ImGui::SetNextWindowPos({screen.x - wanted.x - 10, top}, ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Autocovariance of the frames M-1 and M", &state.correlation,
                     ImGuiWindowFlags_NoFocusOnAppearing)) {
        for (const Side side : {A, B}) {
            if (side == B && !state.order.rival) continue;
            ImGui::PushTextWrapPos();
            ImGui::TextColored(colors::SIDES[side], "%s", sentenceOf(state, side).c_str());
            ImGui::PopTextWrapPos();
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
        if (axes.high.x > axes.low.x + 40 && axes.high.y > axes.low.y + 40) {
            ImDrawList& list = *ImGui::GetWindowDrawList();
            axes.draw(list, "");
            list.PushClipRect(axes.low, axes.high, true);
            for (const Side side : {A, B})
                if (const auto& known = state.findings->curves[side])
                    drawCurve(list, axes, known->curve, ImGui::ColorConvertFloat4ToU32(colors::SIDES[side]),
                              state.scale);
            list.PopClipRect();
        }
    }
    ImGui::End();
}

} // namespace ui
