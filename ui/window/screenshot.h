#pragma once
// A picture kept with all that made it.

#include <string>

#include "ui/window/order.h"

namespace ui
{

// Writes trichrome-N.png, .exr and .json (a preset), and with a moved camera .camera.json, into the working directory;
// N is the first that is free. Returns the `trichrome render` line that gives the same pixels on the same device.
std::string takeScreenshot(const Shot& shot);

} // namespace ui
