#pragma once
// Looking into the reservoirs: false colors of all pixels, the numbers of one, and its paths.

#include "ui/window/window_state.h"

namespace ui
{

Inspect inspectionFor(const WindowState& state); // what pictures must come with
void drawFalseColorRoom(WindowState& state);
void drawPixel(WindowState& state);

// The paths of the inspected pixel of the side that lies under it, over the picture between these corners.
void drawPaths(const WindowState& state, ImVec2 low, ImVec2 high);

} // namespace ui
