#pragma once
// Pictures and films kept with all that makes them. N is the first number that is free: nothing is ever overwritten.

#include <string>

#include "ui/window/order.h"

namespace ui
{

// Writes trichrome-N.png, .exr and .json (a preset), and with a moved camera .camera.json, into the working directory.
// Returns the `trichrome render` line that gives the same pixels on the same device.
std::string takeScreenshot(const Shot& shot);

// Creates the folder trichrome-film-N with a preset and, unless the camera is the scene's, a camera path. Returns the
// line that renders `frames` frames into it: what plays from frame 0 of the timeline on, in which the scene is at
// `start` (none: it rests), for the device and the settings of the shot.
std::string prepareFilm(const Shot& shot, const Order& order, uint64_t frames, std::optional<double> start);

// Writes trichrome-path-N.json, and returns that name.
std::string savePath(const CameraKeys& keys);

} // namespace ui
