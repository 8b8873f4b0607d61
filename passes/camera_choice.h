#pragma once
// Which camera `--camera NAME|INDEX` means.

#include <cstdint>
#include <string>

#include "engine/scene/scene.h"

namespace passes
{

// The first camera of that name, else the camera of that index; empty: the first. Throws Error that lists the cameras.
uint32_t chooseCamera(const scene::Scene& scene, const std::string& nameOrIndex);

} // namespace passes
