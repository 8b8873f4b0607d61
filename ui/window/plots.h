#pragma once
// Error over time, both axes logarithmic, and the figures beside it.

#include "ui/window/window_state.h"

namespace ui
{

void drawErrorPlot(WindowState& state, const ErrorMeter& meter);

} // namespace ui
