#include "ui/window/path_room.h"

#include "engine/base/error.h"
#include "passes/camera_path.h"
#include "ui/window/timeline_room.h"

#include <algorithm>
#include <cmath>

namespace ui
{

namespace
{

// A path on which the camera would look nowhere is refused.
template <class Make>
void change(WindowState& state, Make&& make)
{
    try {
        state.order.path = make();
    } catch (const Error& error) {
        state.message = fmt::format("The camera path stays as it was. {}", error.what());
    }
}

// What is seen stays.
void clear(WindowState& state)
{
    play(state, false);
    state.order.path.reset();
}

void remove(WindowState& state, int64_t frame)
{
    if (framesOf(state.order.path) == std::vector{frame})
        clear(state);
    else
        change(state, [&] { return withoutKey(state.order.path, frame); });
}

void drawKeyframes(WindowState& state, const std::vector<int64_t>& frames)
{
    const std::string count = fmt::format("{} keyframe{}", frames.size(), frames.size() == 1 ? "" : "s");
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 10);
    const bool open = ImGui::BeginCombo("##keyframes", count.c_str());
    remember(state.places, "keyframes");
    if (!open) {
        explain("Choose one to go there.");
        return;
    }
    const auto now = int64_t(frameNow(state));
    for (const int64_t frame : frames) {
        if (ImGui::Selectable(fmt::format("frame {}", frame).c_str(), frame == now))
            goToFrame(state, uint64_t(std::max<int64_t>(frame, 0)));
        remember(state.places, fmt::format("keyframe.{}", frame));
    }
    ImGui::EndCombo();
}

} // namespace

void addKeyframe(WindowState& state)
{
    Order& order = state.order;
    const ShotPointer& shot = state.pictures.sides[A];
    if (!shot || !state.sceneIsThere() || shot->order.scene.name != order.scene.name) return;
    const uint64_t frame = frameNow(state);
    const CameraKeys before = order.path;
    change(state, [&] {
        return withKey(before, frame, order.pose ? *order.pose : viewOf(shot->camera, state.facts->origin));
    });
    if (order.path == before) return;
    state.message = fmt::format("Keyframe of the camera path: frame {}.", frame);
    if (order.playing) {
        if (!before) order.frame = frame, ++order.plays; // from now on frames are counted, not seconds
        return;
    }
    order.frame = frame;
    if (!sceneMoves(state)) order.frame += uint64_t(std::max(std::round(order.play.fps), 1.0));
}

void drawPath(WindowState& state)
{
    if (button(state.places, "Keyframe", "add-keyframe",
               "This view becomes the camera path's at the frame that the timeline shows (M). In a scene at rest the "
               "timeline then goes on by a second, for the next one. Play (T) follows the path."))
        addKeyframe(state);
    ImGui::SameLine();
    state.requests.film |=
        button(state.places, "Film", "film",
               "Prepares a folder trichrome-film-N; the line that renders all frames into it goes to the clipboard "
               "(F11).");
    const std::vector<int64_t> frames = framesOf(state.order.path);
    if (frames.empty()) return;
    ImGui::SameLine();
    drawKeyframes(state, frames);
    ImGui::SameLine();
    const auto now = int64_t(frameNow(state));
    if (button(state.places, "-", "remove-keyframe", "Removes the keyframe of the frame that is shown."))
        remove(state, now);
    ImGui::SameLine();
    if (button(state.places, "x", "clear-path", "Removes all keyframes.")) clear(state);
    ImGui::SameLine();
    state.requests.savePath |= button(state.places, "Save path", "save-path",
                                      "Writes trichrome-path-N.json into the working directory, for --camera-path.");
}

} // namespace ui
