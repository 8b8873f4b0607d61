#pragma once
// What the reservoirs of a picture hold, as colors.

#include <string>

#include "ui/window/picture_view.h"

namespace ui
{

// Gray where the picture came without reservoirs.
ScreenPicture falseColors(const Shot& shot, FalseColor view, int reservoir);

// What the colors mean in this picture: "confidence: black 1, white 20 frames".
std::string legendOf(const Shot& shot, FalseColor view, int reservoir);

// How many reservoirs a pixel of the shot has; 0: it came without.
int reservoirCount(const Shot& shot);

} // namespace ui
