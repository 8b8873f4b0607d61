#include "ui/window/pixel_room.h"

#include "ui/window/false_color.h"

#include "passes/estimator.h"
#include "shaders/shared/streams.h"

#include <algorithm>

namespace ui
{

namespace
{

std::string targetName(const glm::vec3& target)
{
    std::string name;
    for (int c = 0; c < 3; ++c)
        if (target[c] > 0) name += "RGB"[c];
    return name == "RGB" ? "luminance" : name;
}

// What is still being compiled is said, since that can take a while on CPU drivers.
std::string notReadYet(const WindowState& state, const char* what)
{
    const std::string& compiled = state.activity.empty() ? state.ahead : state.activity;
    return fmt::format("{}: not read yet{}{}", what, compiled.empty() ? "" : ". ", compiled);
}

void drawReservoirs(const WindowState& state, const Shot& shot, uint32_t x, uint32_t y)
{
    if (shot.paths.empty()) ImGui::TextColored(colors::AMBER, "%s", notReadYet(state, "paths").c_str());
    if (shot.order.settings.method == passes::Method::Pt) {
        ImGui::TextColored(colors::GRAY, "no reservoirs: the path tracer has none");
        return;
    }
    const int count = reservoirCount(shot);
    if (count == 0) {
        ImGui::TextColored(colors::AMBER, "%s", notReadYet(state, "reservoirs").c_str());
        return;
    }
    const passes::Estimator& estimator = passes::estimatorOf(shot.order.settings.method);
    const size_t pixels = shot.picture.pixels.size(), pixel = size_t{y} * shot.picture.width + x;
    ImGui::Text("confidence %u frames", shot.reservoirs[pixel].confidence);
    if (!ImGui::BeginTable("reservoirs", 7, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) return;
    for (const char* title :
         {"target", "sample: frame/pixel/path id", "bounces", "p_hat", "weight sum", "W", "shifts failed"}) {
        ImGui::TableNextColumn();
        ImGui::TextColored(colors::GRAY, "%s", title);
    }
    for (int c = 0; c < count; ++c) {
        const shared::Inspection& seen = shot.reservoirs[size_t(c) * pixels + pixel];
        const uint32_t pathId = seen.pathIdAndReconnection & 0xffff, r = seen.pathIdAndReconnection >> 16;
        const bool holds = seen.weightSum > 0;
        const auto cell = [](const std::string& text) {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(text.c_str());
        };
        cell(targetName(estimator.target[size_t(c)]));
        cell(holds ? fmt::format("{}/{}/{}", seen.seedFrame & ~shared::SEED_OF_PROPOSAL, seen.seedPixel, pathId)
                   : "none");
        cell(holds ? fmt::format("{}{}", seen.lengthAndShifts & 0xffff, r > 0 ? fmt::format(", joins x{}", r) : "")
                   : "");
        cell(fmt::format("{:.4g}", seen.target));
        cell(fmt::format("{:.4g}", seen.weightSum));
        cell(fmt::format("{:.4g}", seen.weight));
        cell(fmt::format("{} of {}", seen.lengthAndShifts >> 24, seen.lengthAndShifts >> 16 & 0xff));
    }
    ImGui::EndTable();
}

// Where a path's segment from a to b lies on the screen, as far as it is before the camera; false: nowhere.
bool segmentOf(shared::PathPoint a, shared::PathPoint b, ImVec2 low, ImVec2 high, ImVec2 (&ends)[2])
{
    constexpr float NEAREST = 1e-4f; // scaled lengths
    if (a.depth < NEAREST && b.depth < NEAREST) return false;
    const auto cut = [](shared::PathPoint& behind, const shared::PathPoint& before) {
        if (behind.depth >= NEAREST) return;
        const float t = (NEAREST - behind.depth) / (before.depth - behind.depth);
        behind.x += t * (before.x - behind.x);
        behind.y += t * (before.y - behind.y);
        behind.depth = NEAREST;
    };
    cut(a, b);
    cut(b, a);
    const auto at = [&](const shared::PathPoint& p) {
        return ImVec2(low.x + (0.5f + 0.5f * p.x / p.depth) * (high.x - low.x),
                      low.y + (0.5f - 0.5f * p.y / p.depth) * (high.y - low.y));
    };
    ends[0] = at(a);
    ends[1] = at(b);
    return true;
}

void drawPath(ImDrawList& list, const std::vector<shared::PathPoint>& path, ImVec2 low, ImVec2 high, ImU32 color,
              float width)
{
    ImVec2 ends[2];
    for (size_t i = 0; i < path.size(); ++i) {
        if (i > 0 && segmentOf(path[i - 1], path[i], low, high, ends)) list.AddLine(ends[0], ends[1], color, width);
        if (path[i].depth <= 0 || !segmentOf(path[i], path[i], low, high, ends)) continue;
        if (path[i].kind == shared::POINT_LIGHT)
            list.AddNgonFilled(ends[0], 2.5f * width, color, 4);
        else if (path[i].kind == shared::POINT_SURFACE)
            list.AddCircleFilled(ends[0], 1.5f * width, color);
    }
}

// In the panel, where no window covers it: word by word, in lines as wide as it.
void drawLegend(const std::vector<LegendWord>& words)
{
    const float gap = ImGui::GetFontSize();
    float left = 0;
    for (const LegendWord& word : words) {
        const float width = ImGui::CalcTextSize(word.text.c_str()).x;
        if (left > 0 && width < left)
            ImGui::SameLine(0, gap);
        else
            left = ImGui::GetContentRegionAvail().x;
        left -= width + gap;
        sentence({word.color.r, word.color.g, word.color.b, 1}, word.text);
    }
}

} // namespace

Inspect inspectionFor(const WindowState& state)
{
    const FalseColor view = state.view.falseColor;
    return {.reservoirs = state.pixel || (view != FalseColor::Off && view != FalseColor::Floor),
            .shifts = view == FalseColor::ShiftOutcomes,
            .pixel = state.pixel ? state.inspected : std::nullopt};
}

void drawFalseColorRoom(WindowState& state)
{
    int view = int(state.view.falseColor);
    if (ImGui::Combo("false colors", &view,
                     "off\0confidence\0weight W\0which reservoirs agree\0path length\0failed spatial shifts\0"
                     "spatial shifts by outcome\0color noise that stays\0not finite\0"))
        state.view.falseColor = FalseColor(view);
    remember(state.places, "false-colors");
    explain("What the reservoirs hold, read back with every picture (slower). X goes through them.");
    const ShotPointer shot = state.pictures.shotOf(state.view.left());
    const int count = shot ? reservoirCount(*shot) : 0;
    const bool each =
        view >= int(FalseColor::Weight) && view <= int(FalseColor::FailedShifts) && view != int(FalseColor::Agreement);
    if (each && count > 1) {
        ImGui::SliderInt("of reservoir", &state.view.reservoir, 0, count - 1);
        state.view.reservoir = std::clamp(state.view.reservoir, 0, count - 1);
    }
    drawLegend(state.legend);
    checkbox(
        state.places, "inspect the pixel under the mouse (I)", "pixel", state.pixel,
        "Its color, what its reservoirs hold (sample, target p_hat, weight sum, weight W, confidence), and over the "
        "picture the paths that they hold. It stays when the mouse leaves the picture.");
}

void drawPixel(WindowState& state)
{
    if (!state.pixel) return;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({state.panelWidth() + 10, 10}, ImGuiCond_FirstUseEver); // plots open below
    ImGui::SetNextWindowSizeConstraints({200, 0}, {screen.x, screen.y});
    if (ImGui::Begin("Pixel", &state.pixel, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing)) {
        if (!state.inspected) {
            ImGui::TextColored(colors::GRAY, "Move the mouse over the picture.");
        } else {
            for (const Source source : {Source::A, Source::B, Source::Reference}) {
                const image::Image* picture = state.pictures.of(source);
                if (!picture) continue;
                // The mouse is told in pixels of the full size; pictures of a moving camera have fewer.
                const passes::Settings& full = state.order.settings;
                const uint32_t x = std::min((*state.inspected)[0] * picture->width / full.width, picture->width - 1);
                const uint32_t y = std::min((*state.inspected)[1] * picture->height / full.height, picture->height - 1);
                const glm::vec3& color = picture->at(x, y);
                ImGui::TextUnformatted(fmt::format("{}  pixel {}, {}:  {:.5g} {:.5g} {:.5g}",
                                                   source == Source::A   ? "A"
                                                   : source == Source::B ? "B"
                                                                         : "reference",
                                                   x, y, color.r, color.g, color.b)
                                           .c_str());
                if (const ShotPointer shot = state.pictures.shotOf(source)) {
                    ImGui::PushID(int(source));
                    drawReservoirs(state, *shot, x, y);
                    ImGui::PopID();
                }
            }
        }
    }
    ImGui::End();
}

void drawPaths(const WindowState& state, ImVec2 low, ImVec2 high)
{
    if (!state.pixel || !state.inspected) return;
    const View& view = state.view;
    const float at = (float((*state.inspected)[0]) + 0.5f) / float(state.order.settings.width);
    const bool beyond = view.layout == Layout::Split && state.pictures.of(view.right()) && at > view.wipe;
    const ShotPointer shot = state.pictures.shotOf(beyond ? view.right() : view.left());
    if (!shot) return;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.PushClipRect(low, high, true);
    // Paths that are one look like one of several stripes: the first the broadest.
    const size_t count = shot->paths.size();
    const bool resamples = shot->order.settings.method != passes::Method::Pt;
    for (size_t c = 0; c < count; ++c) {
        const glm::vec3 target = resamples ? passes::estimatorOf(shot->order.settings.method).target[c] : glm::vec3(1);
        const auto part = [&](int i) { return target[i] > 0 ? 1.0f : 0.25f; };
        const ImU32 color = ImGui::ColorConvertFloat4ToU32({part(0), part(1), part(2), 1});
        drawPath(list, shot->paths[c], low, high, color, (1.5f + 2 * float(count - 1 - c)) * state.scale);
    }
    list.PopClipRect();
}

} // namespace ui
