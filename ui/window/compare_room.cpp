#include "ui/window/compare_room.h"

#include "ui/window/false_color.h"
#include "ui/window/pixel_room.h"

#include <algorithm>
#include <cmath>

namespace ui
{

namespace
{

constexpr float GRIP = 8; // points to each side of the line

std::string nameOf(const WindowState& state, Source source)
{
    if (source == Source::Reference) return "reference: " + state.pictures.reference->name;
    const ShotPointer shot = state.pictures.shotOf(source);
    const passes::Settings& settings = shot->order.settings;
    std::string text = fmt::format("{}: {}", source == Source::A ? "A" : "B", passes::toText(settings).front().second);
    if (settings.method != passes::Method::Pt)
        text += fmt::format(", {}, M_c {}", passes::toText(settings)[1].second, settings.maxConfidence);
    return text + fmt::format("\n{} frames, {:.1f} s", shot->frames, shot->seconds);
}

ImVec4 colorOf(Source source)
{
    return source == Source::Reference ? ImVec4(0.9f, 0.9f, 0.9f, 1) : colors::SIDES[source == Source::A ? A : B];
}

void label(const WindowState& state, Source source, ImVec2 at, bool fromRight)
{
    const std::string text = nameOf(state, source);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const ImVec2 from = {fromRight ? at.x - size.x : at.x, at.y}, pad = {4, 2};
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddRectFilled({from.x - pad.x, from.y - pad.y}, {from.x + size.x + pad.x, from.y + size.y + pad.y},
                       IM_COL32(0, 0, 0, 170), 3);
    list.AddText(from, ImGui::ColorConvertFloat4ToU32(colorOf(source)), text.c_str());
}

// Word by word from the lower left corner on.
void drawLegend(const std::vector<LegendWord>& words, ImVec2 corner)
{
    float width = 0;
    for (const LegendWord& word : words) width += ImGui::CalcTextSize((word.text + "  ").c_str()).x;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    ImVec2 at = {corner.x, corner.y - ImGui::GetTextLineHeight()};
    list.AddRectFilled({at.x - 4, at.y - 2}, {at.x + width, corner.y + 2}, IM_COL32(0, 0, 0, 190), 3);
    for (const LegendWord& word : words) {
        list.AddText(at, ImGui::ColorConvertFloat4ToU32({word.color.r, word.color.g, word.color.b, 1}),
                     word.text.c_str());
        at.x += ImGui::CalcTextSize((word.text + "  ").c_str()).x;
    }
}

bool there(const WindowState& state, Source source)
{
    return state.pictures.of(source) != nullptr;
}

} // namespace

void compare(WindowState& state, bool on)
{
    if (on == state.order.rival.has_value()) return;
    if (on) {
        state.order.rival = state.order.settings;
        state.order.rival->method = state.order.settings.method == passes::Method::RgbRestir
                                        ? passes::Method::RestirPt
                                        : passes::Method::RgbRestir;
        state.editing = B;
        state.view.first = Source::A;
        state.view.second = Source::B;
        state.view.layout = Layout::Split;
    } else {
        state.order.rival.reset();
        state.editing = A;
        if (state.view.second == Source::B) state.view.layout = Layout::One;
    }
    state.view.flipped = false;
}

void drawCompareRoom(WindowState& state)
{
    bool two = state.order.rival.has_value();
    if (checkbox(state.places, "compare with B (C)", "compare", two,
                 "A second set of settings in the same scene. Both get the same time: the younger renders alone until "
                 "it has caught up."))
        compare(state, two);
    if (state.order.rival) {
        ImGui::SameLine();
        ImGui::TextColored(colors::GRAY, "settings of");
        ImGui::SameLine();
        choose(state.places, "edit", state.editing, {"A", "B"}, "Whose settings the panel shows and changes.");
    }
    const bool reference = state.pictures.reference != nullptr;
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(colors::GRAY, "reference");
    ImGui::SameLine();
    if (button(state.places, "Freeze", "freeze",
               "Keeps the picture that is shown (left of the line) as it is now, to measure against (F). An EXR or PNG "
               "dropped into the window becomes the reference, too."))
        state.requests.freeze = true;
    ImGui::SameLine();
    if (button(state.places, "Converge", "converge",
               "Path traces a reference of this view beside the pictures, with random numbers of its own. It takes its "
               "share of the time, and gets better as long as it is there; its own error is subtracted from the errors "
               "that are shown."))
        state.requests.converge = true;
    if (reference || state.order.studies.reference) {
        ImGui::SameLine();
        state.requests.dropReference |= button(state.places, "Drop it", "drop-reference", "No reference any more.");
    }
    checkbox(state.places, "error (P)", "plots", state.plots, "Error against the reference over time, for A and B.");
    ImGui::SameLine();
    checkbox(state.places, "correlation (K)", "correlation", state.correlation,
             "Autocovariance of successive frames of A and B, measured beside the pictures on a small picture.");
    if (!two && !reference) return;
    View& view = state.view;
    const auto pick = [&](const char* name, Source& source, const char* doc) {
        if (choose(state.places, name, source, {"A", "B", "reference"}, doc)) view.flipped = false;
    };
    pick("first", view.first, "The picture that is shown; left of the line in a split.");
    ImGui::SameLine();
    ImGui::TextColored(colors::GRAY, "shown,");
    pick("second", view.second, "What it is compared with; right of the line in a split.");
    ImGui::SameLine();
    ImGui::TextColored(colors::GRAY, "beside it");
    choose(state.places, "layout", view.layout, {"one (Tab flips)", "split", "difference"},
           "One: Tab flips between the two. Split: drag the line. Difference: its absolute value per channel; exposure "
           "makes it brighter.");
}

bool drawOverPicture(WindowState& state, ImVec2 low, ImVec2 high)
{
    View& view = state.view;
    const bool left = there(state, view.left()), right = there(state, view.right());
    const float top = low.y + 6;
    if (!state.legend.empty() && state.hidden) drawLegend(state.legend, {low.x + 8, high.y - 8});
    drawPaths(state, low, high);
    if (!left || !right) return false; // only one picture: nothing to tell apart
    if (view.layout == Layout::One) {
        label(state, view.left(), {low.x + 8, top}, false);
        return false;
    }
    if (view.layout == Layout::Difference) {
        label(state, view.left(), {low.x + 8, top}, false);
        label(state, view.right(), {high.x - 8, top}, true);
        return false;
    }
    static bool dragging = false;
    const ImGuiIO& io = ImGui::GetIO();
    const float x = low.x + view.wipe * (high.x - low.x);
    state.places["wipe"] = {int(x), int((low.y + high.y) / 2)};
    const bool near = std::abs(io.MousePos.x - x) < GRIP * state.scale && io.MousePos.y >= low.y &&
                      io.MousePos.y < high.y && !io.WantCaptureMouse;
    if (!io.MouseDown[0]) dragging = false;
    if (near && ImGui::IsMouseClicked(0)) dragging = true;
    if (dragging) view.wipe = std::clamp((io.MousePos.x - low.x) / (high.x - low.x), 0.0f, 1.0f);
    if (near || dragging) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    const float line = low.x + view.wipe * (high.x - low.x);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddLine({line, low.y}, {line, high.y},
                 near || dragging ? IM_COL32(255, 255, 255, 255) : IM_COL32(255, 255, 255, 150), state.scale);
    label(state, view.left(), {line - 12, top}, true);
    label(state, view.right(), {line + 12, top}, false);
    return near || dragging;
}

} // namespace ui
