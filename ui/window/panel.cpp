#include "ui/window/panel.h"

#include "passes/variant.h"
#include "ui/cli/presets.h"
#include "ui/window/compare_room.h"
#include "ui/window/path_room.h"
#include "ui/window/pixel_room.h"

#include <cinttypes>
#include <filesystem>
#include <string_view>

namespace ui
{

namespace
{

using namespace colors;
using namespace std::string_view_literals;

void drawBadge(const ShotPointer& shot)
{
    if (!shot) {
        ImGui::TextColored(GRAY, "No picture yet");
        return;
    }
    if (const uint64_t lost = passes::sumOf(shot->stats.nonFinite); lost > 0) {
        sentence(AMBER, fmt::format("BIASED: {} values were not finite and count as 0", lost));
        return;
    }
    ImGui::TextColored(GREEN, "UNBIASED for paths of up to %u bounces", shot->order.settings.maxBounces);
    explain(
        "In every channel the resolve weights of the reservoirs sum to 1 and each reservoir's target covers what it "
        "resolves (checked when the method is chosen), every shift is weighted by its Jacobian and by balance MIS, "
        "and no value of this picture was found not finite. Light that scatters more often than max-bounces is left "
        "out.");
}

void drawActivity(const WindowState& state)
{
    if (!state.activity.empty())
        ImGui::TextColored(AMBER, "%s", state.activity.c_str());
    else if (!state.ahead.empty())
        ImGui::TextColored(GRAY, "%s (ahead)", state.ahead.c_str());
    else
        ImGui::TextColored(GRAY, "%s", state.order.paused ? "Paused" : "Rendering");
}

// Scene, presets, and what goes back and forth.
void drawFiles(WindowState& state)
{
    if (button(state.places, "Open...", "open",
               "Recent scenes and built-in ones; or drop a .gltf or .glb file into the window."))
        ImGui::OpenPopup("open");
    if (ImGui::BeginPopup("open")) {
        for (size_t i = 0; i < state.recent.size(); ++i) {
            const std::string name = std::filesystem::path(state.recent[i]).filename();
            if (ImGui::MenuItem(fmt::format("{}##{}", name, i).c_str())) state.requests.file = state.recent[i];
            remember(state.places, fmt::format("recent.{}", i));
            explain(state.recent[i].c_str());
        }
        ImGui::EndPopup();
    }
    ImGui::SameLine();
    if (button(state.places, "Preset...", "preset",
               "Sets several settings at once; the others stay. A preset's JSON file can be dropped into the window, "
               "too."))
        ImGui::OpenPopup("preset");
    if (ImGui::BeginPopup("preset")) {
        for (const std::string& name : presetNames()) {
            if (ImGui::MenuItem(name.c_str())) state.requests.preset = name;
            remember(state.places, "preset." + name);
        }
        ImGui::EndPopup();
    }
    ImGui::SameLine();
    const auto step = [&](const char* label, bool can, const char* name, const char* doc) {
        if (!can) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.4f);
        const bool pressed = button(state.places, label, name, doc) && can;
        if (!can) ImGui::PopStyleVar();
        return pressed;
    };
    state.requests.undo |= step("Undo", state.canUndo, "undo", "The settings as before the last change (Ctrl+Z).");
    ImGui::SameLine();
    state.requests.redo |= step("Redo", state.canRedo, "redo", "Takes the undoing back (Ctrl+Y).");
    ImGui::SameLine();
    if (button(state.places, "F1", "help", "All keys.")) state.help = !state.help;
}

void drawRun(WindowState& state)
{
    Order& order = state.order;
    if (button(state.places, order.paused ? "Go on" : "Pause", "pause", "Space")) order.paused = !order.paused;
    ImGui::SameLine();
    if (button(state.places, "Step", "step", "One frame, then pause (N).")) order.paused = true, ++order.steps;
    ImGui::SameLine();
    if (button(state.places, "Restart", "restart", "From the first frame again (R).")) ++order.restarts;
    ImGui::SameLine();
    state.requests.resetView |=
        button(state.places, "Reset view", "reset-view", "The camera as the scene has it (Home).");
    ImGui::SameLine();
    state.requests.screenshot |=
        button(state.places, "Save", "screenshot",
               "PNG, EXR and preset into the working directory; the render line that gives the same pixels goes to the "
               "clipboard (F12).");
}

// What the stages were compiled with, what was left out, and what that is worth.
void drawVariant(WindowState& state, const Shot& shot)
{
    if (!ImGui::TreeNode("Compiled in, left out")) return;
    static const std::map<std::string, std::string> MEANINGS = passes::variantMeanings();
    ImGui::PushTextWrapPos();
    for (const bool off : {true, false}) {
        ImGui::TextColored(GRAY, "%s", off ? "left out" : "compiled in");
        for (const auto& [name, value] : shot.stats.variant) {
            if ((value == "off") != off) continue;
            ImGui::Bullet();
            ImGui::TextUnformatted(value == "on" || off ? MEANINGS.at(name).c_str()
                                                        : fmt::format("{}: {}", MEANINGS.at(name), value).c_str());
        }
    }
    if (button(
            state.places, "What does that save?", "savings",
            "Renders frames of A in turns with frames for which everything is compiled in, and compares their times."))
        ++state.order.studies.savings;
    if (const std::optional<Savings>& s = state.findings->savings)
        ImGui::TextUnformatted(
            fmt::format(
                "A frame of A takes {:.3g} ms; with everything compiled in {:.3g} ms, {:.2f} times as long (wall, {} "
                "frames each). The scene's tables: {:.1f} MB instead of {:.1f}.",
                s->neededMilliseconds, s->everythingMilliseconds, s->everythingMilliseconds / s->neededMilliseconds,
                s->frames, double(s->neededBytes) / 1e6, double(s->everythingBytes) / 1e6)
                .c_str());
    else if (state.order.studies.savings > 0)
        ImGui::TextColored(GRAY, "Compiling everything to compare with.");
    ImGui::PopTextWrapPos();
    ImGui::TreePop();
}

void drawFigures(WindowState& state, const Shot& shot)
{
    const passes::RenderStats& stats = shot.stats;
    ImGui::Text("%" PRIu64 " frames in %.1f s, %.1f ms each, %.2f M rays/s", shot.frames, shot.seconds,
                shot.frameMilliseconds, shot.raysPerSecond / 1e6);
    ImGui::Text("%.1f MB, %.0f bytes per pixel, compiled in %.2f s", double(stats.memoryBytes) / 1e6,
                stats.bytesPerPixel, stats.compileSeconds);
    ImGui::TextColored(GRAY, "%s", shot.adapter.name.c_str());
    drawTable("Stages, ms per frame", stats.stageMilliseconds, "{:.2f}");
    drawTable("Rays", stats.rays, "{}");
    drawTable("Shifts by outcome", stats.shifts, "{}");
    drawTable("Values not finite", stats.nonFinite, "{}");
    drawVariant(state, shot);
}

} // namespace

void drawPanel(WindowState& state)
{
    if (state.hidden) return;
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({state.panelWidth(), ImGui::GetIO().DisplaySize.y});
    ImGui::Begin("Trichrome", nullptr,
                 ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                     ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::PushItemWidth(-ImGui::GetFontSize() * 10);
    const ShotPointer& shot = state.pictures.sides[state.editing];
    drawBadge(shot);
    drawActivity(state);
    if (!state.message.empty()) sentence(AMBER, state.message);
    drawFiles(state);
    drawRun(state);
    drawPath(state);
    ImGui::Separator();

    // The three that this window is for come first; the rest in the list's own order. Frames and seconds say when
    // `render` stops; here the picture goes on until paused. What B shares with A is in A's list only.
    using passes::Knob, passes::Role;
    const auto first = [](const Knob& knob) {
        return knob.name == "method"sv || knob.name == "shift"sv || knob.name == "max-confidence"sv;
    };
    const auto seldom = [](const Knob& knob) {
        return knob.role == Role::Sampling || knob.role == Role::Output || knob.role == Role::Scene ||
               knob.name == "camera"sv;
    };
    const auto shown = [&](const Knob& knob) {
        const bool world = knob.role == Role::Scene || knob.role == Role::View;
        return !first(knob) && knob.role != Role::Stopping && !(state.editing == B && world);
    };
    editSettings(state.places, state.edited(), first);
    ImGui::Separator();
    drawCompareRoom(state);
    ImGui::Separator();
    editSettings(state.places, state.edited(), [&](const Knob& knob) { return shown(knob) && !seldom(knob); });
    if (ImGui::TreeNode("Seed, camera, environment")) {
        editSettings(state.places, state.edited(), [&](const Knob& knob) { return shown(knob) && seldom(knob); });
        ImGui::TreePop();
    }
    ImGui::Separator();
    ImGui::SliderFloat("exposure", &state.tone.stops, -10, 10, "%+.2f stops");
    remember(state.places, "exposure");
    int curve = int(state.tone.curve);
    if (ImGui::Combo("tone curve", &curve, "Reinhard\0ACES-like\0none\0")) state.tone.curve = ToneCurve(curve);
    remember(state.places, "tone-curve");
    drawFalseColorRoom(state);
    ImGui::Separator();
    if (shot) drawFigures(state, *shot);
    ImGui::PopItemWidth();
    ImGui::End();
}

void drawHelp(WindowState& state)
{
    if (!state.help) return;
    ImGui::SetNextWindowPos({state.panelWidth() + 20 * state.scale, 20 * state.scale}, ImGuiCond_Appearing);
    if (ImGui::Begin("Keys", &state.help, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings))
        ImGui::TextUnformatted("left drag      orbit around the target; on the split's line: move it\n"
                               "right drag     look around\n"
                               "middle drag    pan\n"
                               "wheel          nearer, farther\n"
                               "W A S D Q E    fly (Shift: faster)\n"
                               "1 to 9         go to a bookmark; with Ctrl: set it here\n"
                               "Home           reset the view\n"
                               "\n"
                               "C              compare with B; again: A alone\n"
                               "Tab            flip between the two pictures\n"
                               "F              freeze the picture as reference\n"
                               "P              error over time\n"
                               "K              autocovariance of successive frames\n"
                               "X              the next false colors\n"
                               "I              inspect the pixel under the mouse, and its paths\n"
                               "\n"
                               "T              play the scene's animations and the camera path, stop\n"
                               ", .            one frame back, on\n"
                               "M              this view becomes a keyframe of the camera path\n"
                               "F11            prepare a film; its render line goes to the clipboard\n"
                               "\n"
                               "Space          pause, go on\n"
                               "N              one frame\n"
                               "R              from the first frame again\n"
                               "Ctrl+Z Ctrl+Y  undo and redo settings\n"
                               "Ctrl+click     type a slider's exact value\n"
                               "F12            save PNG, EXR and preset; the render line goes to the clipboard\n"
                               "H              hide the panel\n"
                               "F1             this list\n"
                               "\n"
                               "Drop a file    .gltf, .glb: scene; .json: preset; .exr, .png: reference");
    ImGui::End();
}

} // namespace ui
