#pragma once
// The sidebar: every setting, what it does to the picture, and what the picture cost.

#include "ui/window/window_state.h"

namespace ui
{

void drawPanel(WindowState& state);

void drawHelp(WindowState& state);

} // namespace ui
