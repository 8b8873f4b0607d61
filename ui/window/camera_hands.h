#pragma once
// How mouse and keyboard move the camera.

#include "ui/window/window_memory.h"
#include "ui/window/window_state.h"

namespace ui
{

class CameraHands
{
  public:
    // `mouseTaken`: the mouse does something else.
    void move(WindowState& state, bool mouseTaken);
    static void reset(Order& order);
    // Keys 1 to 9; true when a bookmark was set.
    bool bookmarks(WindowState& state, WindowMemory& memory);

  private:
    double movedAt_ = -1;
};

} // namespace ui
