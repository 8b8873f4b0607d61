#include "ui/window/camera_hands.h"

#include <algorithm>
#include <cmath>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace ui
{

namespace
{

constexpr double STILL_SECONDS = 0.25;      // after its last move the camera stands
constexpr double RADIANS_PER_POINT = 0.006; // of dragging

// The pose to change, at first that of what is seen; null before there is a picture of the scene.
Pose* poseIn(WindowState& state)
{
    const ShotPointer& shot = state.pictures.sides[A];
    if (!shot || !state.sceneIsThere() || shot->order.scene.name != state.order.scene.name) return nullptr;
    if (!state.order.pose) state.order.pose = poseOf(shot->camera, state.facts->origin);
    return &*state.order.pose;
}

} // namespace

void CameraHands::reset(Order& order)
{
    order.pose.reset();
    order.moving = false;
}

void CameraHands::move(WindowState& state, bool mouseTaken)
{
    Order& order = state.order;
    const ImGuiIO& io = ImGui::GetIO();
    const std::optional<Pose> before = order.pose;
    const bool dragging = io.MouseDelta.x != 0 || io.MouseDelta.y != 0;
    if (!io.WantCaptureMouse && !mouseTaken && (dragging || io.MouseWheel != 0)) {
        const double x = io.MouseDelta.x * RADIANS_PER_POINT, y = io.MouseDelta.y * RADIANS_PER_POINT;
        const bool left = io.MouseDown[0], right = io.MouseDown[1], middle = io.MouseDown[2];
        Pose* p = left || right || middle || io.MouseWheel != 0 ? poseIn(state) : nullptr;
        if (p && left) orbit(*p, -x, y);
        if (p && right) look(*p, -x, -y);
        if (p && middle) pan(*p, -io.MouseDelta.x / io.DisplaySize.y, io.MouseDelta.y / io.DisplaySize.y);
        if (p && io.MouseWheel != 0) dolly(*p, std::pow(0.9, double(io.MouseWheel)));
    }
    if (!io.WantCaptureKeyboard && !io.KeyCtrl) {
        const auto axis = [](int plus, int minus) {
            return double(ImGui::IsKeyDown(plus)) - double(ImGui::IsKeyDown(minus));
        };
        const glm::dvec3 way(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q), axis(GLFW_KEY_W, GLFW_KEY_S));
        Pose* p = way != glm::dvec3(0) ? poseIn(state) : nullptr;
        if (p) {
            const double speed = (io.KeyShift ? 4 : 1) * glm::length(p->target - p->position);
            fly(*p, way * speed * std::min(double(io.DeltaTime), 0.1));
        }
    }
    if (order.pose != before && order.pose) {
        movedAt_ = glfwGetTime();
        order.moving = true;
    } else if (glfwGetTime() - movedAt_ > STILL_SECONDS) {
        order.moving = false;
    }
}

bool CameraHands::bookmarks(WindowState& state, WindowMemory& memory)
{
    if (ImGui::GetIO().WantCaptureKeyboard) return false;
    for (const KeyPress& press : state.keys) {
        const int i = press.key - GLFW_KEY_1;
        if (i < 0 || i >= int(BOOKMARKS)) continue;
        std::optional<Pose>& bookmark = memory.bookmarks[state.order.scene.name][size_t(i)];
        if ((press.modifiers & GLFW_MOD_CONTROL) != 0) {
            const bool placed = state.order.pose.has_value();
            if (const Pose* pose = poseIn(state)) bookmark = *pose;
            if (!placed) state.order.pose.reset(); // setting one moves nothing
            state.message = fmt::format("Bookmark {} is here.", i + 1);
            return true;
        }
        if (bookmark)
            state.order.pose = bookmark;
        else
            state.message = fmt::format("There is no bookmark {} in this scene; Ctrl+{} sets it.", i + 1, i + 1);
    }
    return false;
}

} // namespace ui
