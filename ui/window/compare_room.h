#pragma once
// The part of the panel about A, B and the reference, and what is written over the picture.

#include "ui/window/window_state.h"

namespace ui
{

void drawCompareRoom(WindowState& state);

// The line of the split and the names of what is left and right of it. `low` and `high`: the picture's corners, in
// points. Drags the line; true while the mouse is the line's and not the camera's.
bool drawOverPicture(WindowState& state, ImVec2 low, ImVec2 high);

} // namespace ui
