#pragma once
// Clicks, each where it happened and none lost. ImGui 1.86 reads the mouse once a frame, and frames take long on a busy
// machine: of a click whose mouse has moved on by then it would see the button in one place and the mouse in another.

#include <array>
#include <deque>

#include <imgui.h>

namespace ui
{

class Mouse
{
  public:
    void moved(ImVec2 to) { at_ = to; }
    void turned(int button, bool down); // where it is; buttons as GLFW and ImGui number them, others are ignored
    void play(ImGuiIO& io);             // the next of them; once a frame, after the backend has read the mouse
    bool isBehind() const { return !events_.empty(); } // the next frames have more of them

  private:
    struct Event {
        int button;
        bool down;
        ImVec2 at;
    };
    ImVec2 at_ = {};
    std::deque<Event> events_;
    std::array<bool, ImGuiMouseButton_COUNT> down_ = {};
};

} // namespace ui
