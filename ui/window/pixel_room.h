#pragma once
// The pixel under the mouse and what its reservoirs hold; the false colors.

#include "ui/window/window_state.h"

namespace ui
{

void drawFalseColorRoom(WindowState& state);
void drawPixel(WindowState& state); // a window of its own, while state.pixel

// Whether reservoirs must be read back for what is shown.
bool wantsReservoirs(const WindowState& state);

} // namespace ui
