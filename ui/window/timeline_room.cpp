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

bool somethingPlays(const WindowState& state)
{
    return playable(state) || (state.order.path && state.sceneIsThere());
}

// Of the last frame that was shown since it has begun to play; null: none so far, or it does not play.
const Shot* playedShot(const WindowState& state)
{
    const Shot* shot = state.pictures.sides[A].get();
    const Order& order = state.order;
    const bool plays = order.playing && shot && shot->order.playing && shot->order.scene == order.scene &&
                       shot->order.plays == order.plays && shot->frames > 0;
    return plays ? shot : nullptr;
}

// What the picture shows while it plays, else what is ordered.
double secondsNow(const WindowState& state)
{
    const Shot* shot = playedShot(state);
    return shot && shot->sceneSeconds ? *shot->sceneSeconds : state.order.scene.time.value_or(0);
}

double stepOf(const Play& play)
{
    return play.speed / play.fps;
}

double secondsOf(const WindowState& state, uint64_t frame)
{
    const Order& order = state.order;
    return passes::playedAt(startOfScene(state) + double(frame) * stepOf(order.play),
                            lengthOf(state.facts->animations, order.scene), order.play.loop);
}

// The first frame that shows the scene so, or nearly.
uint64_t frameOf(const WindowState& state, double seconds)
{
    const Order& order = state.order;
    const double step = stepOf(order.play), length = lengthOf(state.facts->animations, order.scene);
    if (step == 0) return order.frame;
    double way = (seconds - startOfScene(state)) / step;
    if (way < 0 && order.play.loop) way += length / std::abs(step);
    return uint64_t(std::clamp(std::round(way), 0.0, double(passes::MAX_KEYFRAME)));
}

void goTo(WindowState& state, double seconds)
{
    SceneSource& scene = state.order.scene;
    const std::vector<AnimationFacts>& all = state.facts->animations;
    const auto fit = std::ranges::find(all, true, [](const AnimationFacts& one) { return one.fault.empty(); });
    const bool allFit = std::ranges::all_of(all, [](const AnimationFacts& one) { return one.fault.empty(); });
    if (scene.animation.empty() && !allFit) scene.animation = wordOf(all, size_t(fit - all.begin()));
    scene.time = seconds;
    state.order.frame = frameOf(state, seconds);
}

// The camera stays.
void setFrame(WindowState& state, uint64_t frame)
{
    if (sceneMoves(state)) goTo(state, secondsOf(state, frame));
    state.order.frame = frame;
}

// Playing gives the camera to the path. Stopped, it stays where the path or hands have it.
void playPath(WindowState& state, bool on)
{
    Order& order = state.order;
    const uint64_t frame = frameNow(state);
    if (on) {
        if (playable(state) && order.scene.atRest()) goTo(state, 0);
        setFrame(state, frame + 1 < framesOfAll(state) ? frame : 0);
        order.pose.reset();
    } else {
        const std::optional<Pose> held = order.pose;
        goToFrame(state, frame);
        if (held) order.pose = held;
    }
}

bool atTheEnd(const WindowState& state, double seconds)
{
    const Play& play = state.order.play;
    const double end = play.speed < 0 ? 0 : lengthOf(state.facts->animations, state.order.scene);
    return !play.loop && play.speed != 0 && seconds == end;
}

void drawFrames(WindowState& state)
{
    constexpr double BEYOND = 2; // seconds, where the next keyframe may be
    const uint64_t zero = 0, now = frameNow(state), all = framesOfAll(state);
    const uint64_t most = std::max(all + uint64_t(BEYOND * state.order.play.fps), now);
    uint64_t frame = now;
    std::string text = fmt::format("frame {}", now);
    if (all > 0) text += fmt::format(" of {}", all - 1);
    if (sceneMoves(state)) text += fmt::format(", {:.3f} s", secondsNow(state));
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderScalar("##frame", ImGuiDataType_U64, &frame, &zero, &most, text.c_str())) {
        frame = std::min<uint64_t>(frame, passes::MAX_KEYFRAME);
        if (state.order.playing)
            setFrame(state, frame), ++state.order.plays;
        else
            goToFrame(state, frame);
    }
    remember(state.places, "frame");
    explain("The frame that is shown. Drag to go along the camera path, which plays on from there; Ctrl+click to type "
            "one.");
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

void drawSpeed(WindowState& state)
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
}

void drawPace(WindowState& state)
{
    Play& play = state.order.play;
    const Play before = play;
    const uint64_t frame = frameNow(state);
    if (playable(state)) drawSpeed(state);
    checkbox(state.places, "loop", "loop", play.loop, "Begins again after the last key; else it stops there.");
    if (play != before && state.order.path) setFrame(state, frame); // it is of another time now
}

} // namespace

float timelineHeight(const WindowState& state)
{
    if (state.hidden || !somethingPlays(state)) return 0;
    const ImGuiStyle& style = ImGui::GetStyle();
    return 2 * ImGui::GetFrameHeight() + style.ItemSpacing.y + 2 * style.WindowPadding.y;
}

bool sceneMoves(const WindowState& state)
{
    return playable(state) && !state.order.scene.atRest();
}

double startOfScene(const WindowState& state)
{
    const Play& play = state.order.play;
    const bool fromTheEnd = play.speed < 0 && !play.loop && state.start == 0;
    return fromTheEnd ? lengthOf(state.facts->animations, state.order.scene) : state.start;
}

uint64_t frameNow(const WindowState& state)
{
    const Order& order = state.order;
    if (!order.path && sceneMoves(state)) return frameOf(state, secondsNow(state));
    const Shot* shot = playedShot(state);
    return shot ? shot->firstFrame + shot->frames - 1 : order.frame;
}

void goToFrame(WindowState& state, uint64_t frame)
{
    const ShotPointer& shot = state.pictures.sides[A];
    state.order.playing = false;
    setFrame(state, frame);
    if (state.order.path && shot) state.order.pose = poseAt(state.order.path, shot->camera, frame);
}

uint64_t framesOfAll(const WindowState& state)
{
    const std::vector<int64_t> keys = framesOf(state.order.path);
    if (keys.size() > 1) return uint64_t(std::max<int64_t>(keys.back(), 0)) + 1;
    const Play& play = state.order.play;
    if (!sceneMoves(state) || play.speed == 0) return 0;
    const double steps = lengthOf(state.facts->animations, state.order.scene) / std::abs(stepOf(play));
    // Where it begins again the end is the beginning.
    return play.loop ? std::max<uint64_t>(uint64_t(std::round(steps)), 1) : uint64_t(steps) + 1;
}

void play(WindowState& state, bool on)
{
    Order& order = state.order;
    if (!somethingPlays(state) || on == order.playing) return;
    if (order.path) {
        playPath(state, on);
    } else {
        double seconds = secondsNow(state);
        if (on && atTheEnd(state, seconds))
            seconds = order.play.speed < 0 ? lengthOf(state.facts->animations, order.scene) : 0;
        goTo(state, seconds);
    }
    order.playing = on;
    if (!on) return;
    ++order.plays;
    order.paused = false;
}

void stepScene(WindowState& state, int frames)
{
    if (!somethingPlays(state)) return;
    const Play& play = state.order.play;
    if (state.order.path) {
        const int64_t frame = int64_t(frameNow(state)) + frames;
        goToFrame(state, uint64_t(std::clamp<int64_t>(frame, 0, passes::MAX_KEYFRAME)));
        return;
    }
    const double step = play.speed != 0 ? stepOf(play) : 1 / play.fps;
    const double seconds = secondsNow(state) + frames * step;
    state.order.playing = false;
    goTo(state, passes::playedAt(seconds, lengthOf(state.facts->animations, state.order.scene), play.loop));
}

void stopAtTheEnd(WindowState& state)
{
    const Shot* shot = playedShot(state);
    if (!somethingPlays(state) || !shot || shot->frames < 2) return;
    if (!state.order.path) {
        if (atTheEnd(state, secondsNow(state))) play(state, false);
        return;
    }
    const uint64_t all = framesOfAll(state);
    if (all == 0 || frameNow(state) + 1 < all) return;
    if (!state.order.play.loop) {
        goToFrame(state, all - 1);
        return;
    }
    setFrame(state, 0);
    ++state.order.plays;
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
    if (state.order.path)
        drawFrames(state);
    else
        drawSlider(state, lengthOf(*all, state.order.scene));
    if (button(state.places, state.order.playing ? "Stop" : "Play", "play",
               "Each frame shows the scene a little later, seen from further along the camera path (T). Stopped, it "
               "rests, and its picture gets better."))
        play(state, !state.order.playing);
    ImGui::SameLine();
    if (button(state.places, "<", "frame-back", "One frame back (comma).")) stepScene(state, -1);
    ImGui::SameLine();
    if (button(state.places, ">", "frame-on", "One frame on (period).")) stepScene(state, 1);
    ImGui::SameLine();
    if (all) {
        if (button(state.places, "At rest", "rest", "The scene as its nodes state it, without any animation.")) {
            state.order.playing = false;
            state.order.scene.time.reset();
            state.order.scene.animation.clear();
        }
        ImGui::SameLine();
        drawChoice(state, *all);
        ImGui::SameLine();
    }
    drawPace(state);
    ImGui::End();
}

} // namespace ui
