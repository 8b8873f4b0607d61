#pragma once
// Numbers per pixel as colors.

#include <cstddef>
#include <string>
#include <vector>

#include "engine/image/plane.h"

namespace ui
{

enum class ColorMap {
    Magma,  // dark to bright: sizes
    BlueRed // blue, white, red: less, equal, more
};

// PNG bytes; values below `low` and above `high` get the end colors.
std::vector<std::byte> heatMapPng(const image::Plane& plane, double low, double high, ColorMap map);

// The same colors from low to high, as stops of a gradient in CSS.
std::string gradientOf(ColorMap map);

} // namespace ui
