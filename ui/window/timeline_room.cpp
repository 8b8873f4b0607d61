#include "ui/window/timeline_room.h"

#include "passes/sequence.h"

#include <algorithm>

namespace ui
{

namespace
{

using namespace colors;

// Null: nothing can play.
const std::vector<AnimationFacts>* playable(const WindowState& state)
{
    if (!state.sceneIsThere()) return nullptr;
    const std::vector<AnimationFacts>& all = state.facts->animations;
    const bool any = std::ranges::any_of(all, [](const AnimationFacts& one) { return one.fault.empty(); });
    return any ? &all : nullptr;
}

// What --animation calls it: the first of a name has it.
std::string wordOf(const std::vector<AnimationFacts>& all, size_t index)
{
    const std::string& name = all[index].name;
    const size_t first = size_t(std::ranges::find(all, name, &AnimationFacts::name) - all.begin());
    const bool plain = !name.empty() && name != "all" && name != "off" && first == index;
    return plain ? name : std::to_string(index);
}

bool chosen(const std::vector<AnimationFacts>& all, const SceneSource& scene, size_t index)
{
    return scene.animation == wordOf(all, index) || scene.animation == std::to_string(index);
}

bool allChosen(const SceneSource& scene)
{
    return scene.animation.empty() || scene.animation == "all";
}

double lengthOf(const std::vector<AnimationFacts>& all, const SceneSource& scene)
{
    double length = 0;
    for (size_t i = 0; i < all.size(); ++i)
        if (allChosen(scene) || chosen(all, scene, i)) length = std::max(length, all[i].seconds);
    return length;
}

// What the picture shows while it plays, else what is ordered.
double secondsNow(const WindowState& state)
{
    const ShotPointer& shot = state.pictures.sides[A];
    const Order& order = state.order;
    const bool plays = order.playing && shot && shot->order.playing && shot->order.scene == order.scene;
    return plays && shot->sceneSeconds ? *shot->sceneSeconds : order.scene.time.value_or(0);
}

void goTo(WindowState& state, double seconds)
{
    SceneSource& scene = state.order.scene;
    const std::vector<AnimationFacts>& all = state.facts->animations;
    const auto fit = std::ranges::find(all, true, [](const AnimationFacts& one) { return one.fault.empty(); });
    const bool allFit = std::ranges::all_of(all, [](const AnimationFacts& one) { return one.fault.empty(); });
    if (scene.animation.empty() && !allFit) scene.animation = wordOf(all, size_t(fit - all.begin()));
    scene.time = seconds;
}

bool atTheEnd(const WindowState& state, double seconds)
{
    const Play& play = state.order.play;
    const double end = play.speed < 0 ? 0 : lengthOf(state.facts->animations, state.order.scene);
    return !play.loop && play.speed != 0 && seconds == end;
}

void drawSlider(WindowState& state, double length)
{
    const double zero = 0;
    double seconds = secondsNow(state);
    ImGui::SetNextItemWidth(-1);
    const std::string text = state.order.scene.atRest()
                                 ? "at rest"
                                 : fmt::format("{:.3f} s of {:.3f}", std::clamp(seconds, 0.0, length), length);
    if (ImGui::SliderScalar("##time", ImGuiDataType_Double, &seconds, &zero, &length, text.c_str(),
                            ImGuiSliderFlags_AlwaysClamp))
        goTo(state, seconds);
    remember(state.places, "timeline");
    explain("The time that the scene shows. Drag to scrub; while it plays it goes on from there.");
}

void drawChoice(WindowState& state, const std::vector<AnimationFacts>& all)
{
    SceneSource& scene = state.order.scene;
    const auto labelOf = [&](size_t i) { return all[i].name.empty() ? fmt::format("animation {}", i) : all[i].name; };
    std::string now = "all";
    if (!allChosen(scene))
        for (size_t i = 0; i < all.size(); ++i)
            if (chosen(all, scene, i)) now = labelOf(i);
    const auto choice = [&](const std::string& label, const std::string& word, const std::string& name,
                            const std::string& fault) {
        const auto flags = fault.empty() ? ImGuiSelectableFlags_None : ImGuiSelectableFlags_Disabled;
        if (ImGui::Selectable(fmt::format("{}##{}", label, name).c_str(), label == now, flags)) {
            const double seconds = secondsNow(state);
            scene.animation = word;
            scene.time = std::min(seconds, lengthOf(all, scene));
        }
        remember(state.places, name);
        if (!fault.empty()) explain(fault.c_str());
    };
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 11);
    const bool open = ImGui::BeginCombo("##animation", now.c_str());
    remember(state.places, "animation");
    if (!open) {
        explain("Which animations play. Where several of them move the same thing, the first does.");
        return;
    }
    const auto faulty = std::ranges::find_if(all, [](const AnimationFacts& one) { return !one.fault.empty(); });
    choice("all", "all", "animation.all", faulty == all.end() ? "" : faulty->fault);
    for (size_t i = 0; i < all.size(); ++i)
        choice(labelOf(i), wordOf(all, i), fmt::format("animation.{}", i), all[i].fault);
    ImGui::EndCombo();
}

void drawPace(WindowState& state)
{
    Play& play = state.order.play;
    const float width = ImGui::GetFontSize() * 5;
    ImGui::SetNextItemWidth(width);
    double fps = play.fps;
    if (ImGui::InputDouble("fps", &fps, 0, 0, "%.4g", ImGuiInputTextFlags_EnterReturnsTrue) && fps > 0 && fps <= 1000)
        play.fps = fps;
    remember(state.places, "fps");
    explain("Each rendered frame shows the scene 1 / fps seconds later (times the speed), however long it takes to "
            "render: what is seen does not depend on how fast this machine is.");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(width);
    double speed = play.speed;
    if (ImGui::InputDouble("speed", &speed, 0, 0, "%.4g", ImGuiInputTextFlags_EnterReturnsTrue) && speed >= -100 &&
        speed <= 100)
        play.speed = speed;
    remember(state.places, "speed");
    explain("1: as the file says; negative: backwards.");
    ImGui::SameLine();
    checkbox(state.places, "loop", "loop", play.loop, "Begins again after the last key; else it stops there.");
}

} // namespace

float timelineHeight(const WindowState& state)
{
    if (state.hidden || !playable(state)) return 0;
    const ImGuiStyle& style = ImGui::GetStyle();
    return 2 * ImGui::GetFrameHeight() + style.ItemSpacing.y + 2 * style.WindowPadding.y;
}

void play(WindowState& state, bool on)
{
    if (!playable(state) || on == state.order.playing) return;
    double seconds = secondsNow(state);
    if (on && atTheEnd(state, seconds))
        seconds = state.order.play.speed < 0 ? lengthOf(state.facts->animations, state.order.scene) : 0;
    goTo(state, seconds);
    state.order.playing = on;
    if (on) state.order.paused = false;
}

void stepScene(WindowState& state, int frames)
{
    const std::vector<AnimationFacts>* all = playable(state);
    if (!all) return;
    const Play& play = state.order.play;
    const double step = (play.speed != 0 ? play.speed : 1) / play.fps;
    const double seconds = secondsNow(state) + frames * step;
    state.order.playing = false;
    goTo(state, passes::playedAt(seconds, lengthOf(*all, state.order.scene), play.loop));
}

void stopAtTheEnd(WindowState& state)
{
    const ShotPointer& shot = state.pictures.sides[A];
    if (!playable(state) || !state.order.playing || !shot || !shot->order.playing || shot->frames < 2) return;
    if (atTheEnd(state, secondsNow(state))) play(state, false);
}

void drawTimeline(WindowState& state)
{
    const std::vector<AnimationFacts>* all = playable(state);
    const float height = timelineHeight(state);
    if (height == 0) return;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({state.panelWidth(), screen.y - height});
    ImGui::SetNextWindowSize({screen.x - state.panelWidth(), height});
    ImGui::Begin("Timeline", nullptr,
                 ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                     ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollbar);
    drawSlider(state, lengthOf(*all, state.order.scene));
    if (button(state.places, state.order.playing ? "Stop" : "Play", "play",
               "Each frame shows the scene a little later (T). Stopped, it rests, and its picture gets better."))
        play(state, !state.order.playing);
    ImGui::SameLine();
    if (button(state.places, "<", "frame-back", "One frame back (comma).")) stepScene(state, -1);
    ImGui::SameLine();
    if (button(state.places, ">", "frame-on", "One frame on (period).")) stepScene(state, 1);
    ImGui::SameLine();
    if (button(state.places, "At rest", "rest", "The scene as its nodes state it, without any animation.")) {
        state.order.playing = false;
        state.order.scene.time.reset();
        state.order.scene.animation.clear();
    }
    ImGui::SameLine();
    drawChoice(state, *all);
    ImGui::SameLine();
    drawPace(state);
    ImGui::End();
}

} // namespace ui
