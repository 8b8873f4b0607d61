#pragma once
// What is measured of the sides, both axes logarithmic.

#include "ui/window/window_state.h"

namespace ui
{

void drawErrorPlot(WindowState& state, const ErrorMeter& meter); // against time, and figures beside it
void drawCorrelationPlot(WindowState& state);                    // against M

} // namespace ui
