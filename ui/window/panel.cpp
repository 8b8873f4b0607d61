#include "ui/window/panel.h"

#include "passes/variant.h"

#include <algorithm>
#include <cinttypes>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

namespace ui
{

namespace
{

const ImVec4 GREEN = {0.45f, 0.85f, 0.5f, 1}, AMBER = {1.0f, 0.75f, 0.3f, 1}, GRAY = {0.65f, 0.65f, 0.68f, 1};

void remember(PanelState& state, const std::string& name)
{
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    state.places[name] = {int(low.x + high.x) / 2, int(low.y + high.y) / 2};
}

void explain(const char* text)
{
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

// Enumerations are told from their words: one button each.
template <class T>
requires std::is_enum_v<T>
void edit(PanelState& state, const passes::Knob& knob, T& value, std::initializer_list<const char*> labels)
{
    ImGui::TextUnformatted(knob.name);
    explain(knob.doc);
    int i = 0;
    for (const char* label : labels) {
        if (i > 0) ImGui::SameLine();
        if (ImGui::RadioButton(fmt::format("{}##{}", label, knob.name).c_str(), int(value) == i)) value = T(i);
        remember(state, fmt::format("{}.{}", knob.name, i));
        explain(knob.doc);
        ++i;
    }
}

void edit(PanelState& state, const passes::Knob& knob, passes::Method& value)
{
    edit(state, knob, value, {"off (pt)", "luminance", "RGB", "grouped"});
}
void edit(PanelState& state, const passes::Knob& knob, passes::Shift& value)
{
    edit(state, knob, value, {"replay", "reconnection", "hybrid"});
}
void edit(PanelState& state, const passes::Knob& knob, passes::PixelFilter& value)
{
    edit(state, knob, value, {"center", "box"});
}
void edit(PanelState& state, const passes::Knob& knob, bool& value)
{
    ImGui::Checkbox(knob.name, &value);
    remember(state, knob.name);
    explain(knob.doc);
}
void edit(PanelState& state, const passes::Knob& knob, uint32_t& value)
{
    const uint32_t low = uint32_t(knob.low), high = uint32_t(knob.high);
    const auto flags = ImGuiSliderFlags_AlwaysClamp | (high > 1000 ? ImGuiSliderFlags_Logarithmic : 0);
    ImGui::SliderScalar(knob.name, ImGuiDataType_U32, &value, &low, &high, "%u", flags);
    remember(state, knob.name);
    explain(knob.doc);
}
void edit(PanelState& state, const passes::Knob& knob, float& value)
{
    ImGui::SliderFloat(knob.name, &value, float(knob.low), float(knob.high), "%.3g",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    remember(state, knob.name);
    explain(knob.doc);
}
void edit(PanelState&, const passes::Knob& knob, double& value)
{
    ImGui::InputDouble(knob.name, &value);
    explain(knob.doc);
}
void edit(PanelState& state, const passes::Knob& knob, uint64_t& value)
{
    ImGui::InputScalar(knob.name, ImGuiDataType_U64, &value, nullptr, nullptr, "%" PRIu64,
                       ImGuiInputTextFlags_EnterReturnsTrue);
    remember(state, knob.name);
    explain(knob.doc);
}
void edit(PanelState&, const passes::Knob& knob, std::string& value)
{
    std::string text = value;
    if (ImGui::InputText(knob.name, &text, ImGuiInputTextFlags_EnterReturnsTrue)) value = text;
    explain(knob.doc);
}
void edit(PanelState&, const passes::Knob& knob, passes::SizeField<uint32_t>&& size)
{
    int values[2] = {int(size.width), int(size.height)};
    if (ImGui::InputInt2(knob.name, values, ImGuiInputTextFlags_EnterReturnsTrue)) {
        size.width = uint32_t(std::clamp(values[0], 1, 8192));
        size.height = uint32_t(std::clamp(values[1], 1, 8192));
    }
    explain(knob.doc);
}

void drawBadge(const std::shared_ptr<const Shot>& shot)
{
    if (!shot) return;
    uint64_t lost = 0;
    for (const auto& [stage, count] : shot->stats.nonFinite) lost += count;
    if (lost > 0) {
        ImGui::TextColored(AMBER, "BIASED: %llu values were not finite and count as 0",
                           static_cast<unsigned long long>(lost));
        return;
    }
    ImGui::TextColored(GREEN, "UNBIASED for paths of up to %u bounces", shot->order.settings.maxBounces);
    explain(
        "In every channel the resolve weights of the reservoirs sum to 1 and each reservoir's target covers what it "
        "resolves (checked when the method is chosen), every shift is weighted by its Jacobian and by balance MIS, "
        "and no value of this picture was found not finite. Light that scatters more often than max-bounces is left "
        "out.");
}

template <class Value>
void drawTable(const char* title, const std::map<std::string, Value>& rows, const char* format)
{
    if (!ImGui::TreeNode(title)) return;
    for (const auto& [name, value] : rows) {
        ImGui::TextColored(GRAY, "%s", name.c_str());
        ImGui::SameLine(ImGui::GetFontSize() * 14);
        ImGui::TextUnformatted(fmt::format(fmt::runtime(format), value).c_str());
    }
    ImGui::TreePop();
}

void drawFigures(const Shot& shot)
{
    const passes::RenderStats& stats = shot.stats;
    ImGui::Text("%llu frames, %.1f ms each, %.2f M rays/s", static_cast<unsigned long long>(shot.frames),
                shot.frameMilliseconds, shot.raysPerSecond / 1e6);
    ImGui::Text("%.1f MB, %.0f bytes per pixel, compiled in %.2f s", double(stats.memoryBytes) / 1e6,
                stats.bytesPerPixel, stats.compileSeconds);
    ImGui::TextColored(GRAY, "%s", shot.adapter.name.c_str());
    drawTable("Stages, ms per frame", stats.stageMilliseconds, "{:.2f}");
    drawTable("Rays", stats.rays, "{}");
    drawTable("Shifts by outcome", stats.shifts, "{}");
    drawTable("Values not finite", stats.nonFinite, "{}");
    drawTable("Compiled in, left out", stats.variant, "{}");
}

} // namespace

void drawPanel(PanelState& state, const std::shared_ptr<const Shot>& shot, const std::string& activity, float scale)
{
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({PANEL_WIDTH * scale, ImGui::GetIO().DisplaySize.y});
    ImGui::Begin("Trichrome", nullptr,
                 ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                     ImGuiWindowFlags_NoTitleBar);
    ImGui::PushItemWidth(-ImGui::GetFontSize() * 10);
    drawBadge(shot);
    if (activity.empty())
        ImGui::TextColored(GRAY, "%s", state.order.paused ? "Paused" : "Rendering");
    else
        ImGui::TextColored(AMBER, "%s", activity.c_str());
    ImGui::Separator();

    passes::Settings& settings = state.order.settings;
    // The three that this window is for come first; the rest in the list's own order. Frames and seconds say when
    // `render` stops; here the picture goes on until paused.
    const auto visit = [&](auto&& wanted) {
        passes::visitSettings(settings, [&]<class T>(const passes::Knob& knob, T&& field) {
            if (wanted(std::string(knob.name))) edit(state, knob, std::forward<T>(field));
        });
    };
    const auto first = [](const std::string& name) {
        return name == "method" || name == "shift" || name == "max-confidence";
    };
    visit(first);
    ImGui::Separator();
    visit([&](const std::string& name) { return !first(name) && name != "frames" && name != "seconds"; });

    ImGui::Separator();
    ImGui::SliderFloat("exposure", &state.tone.stops, -10, 10, "%+.2f stops");
    int curve = int(state.tone.curve);
    if (ImGui::Combo("tone curve", &curve, "Reinhard\0ACES-like\0none\0")) state.tone.curve = ToneCurve(curve);

    if (ImGui::Button(state.order.paused ? "Go on" : "Pause")) state.order.paused = !state.order.paused;
    remember(state, "pause");
    ImGui::SameLine();
    if (ImGui::Button("Step")) state.order.paused = true, ++state.order.steps;
    ImGui::SameLine();
    if (ImGui::Button("Restart")) ++state.order.restarts;
    ImGui::SameLine();
    state.resetView |= ImGui::Button("Reset view");
    ImGui::SameLine();
    state.screenshot |= ImGui::Button("Save");
    remember(state, "screenshot");
    ImGui::SameLine();
    if (ImGui::Button("F1")) state.help = !state.help;

    if (!state.message.empty()) {
        ImGui::Separator();
        ImGui::PushTextWrapPos();
        ImGui::TextColored(AMBER, "%s", state.message.c_str());
        ImGui::PopTextWrapPos();
    }
    ImGui::Separator();
    if (shot) drawFigures(*shot);
    ImGui::PopItemWidth();
    ImGui::End();
}

void drawHelp(bool& open)
{
    if (!open) return;
    ImGui::SetNextWindowPos({PANEL_WIDTH + 40, 40}, ImGuiCond_Appearing);
    if (ImGui::Begin("Keys", &open, ImGuiWindowFlags_AlwaysAutoResize))
        ImGui::TextUnformatted("left drag      orbit around the target\n"
                               "right drag     look around\n"
                               "middle drag    pan\n"
                               "wheel          nearer, farther\n"
                               "W A S D Q E    fly (Shift: faster)\n"
                               "Home           reset the view\n"
                               "Space          pause, go on\n"
                               "N              one frame\n"
                               "R              from the first frame again\n"
                               "F12            save PNG, EXR and preset; the render line goes to the clipboard\n"
                               "F1             this list\n"
                               "Ctrl+click     type a slider's exact value\n"
                               "Drop           .gltf, .glb: scene; .json: preset");
    ImGui::End();
}

} // namespace ui
