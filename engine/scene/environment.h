#pragma once
// Environment maps: equirectangular pictures (.exr, .hdr) as light from infinity.

#include <filesystem>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace scene
{

// Finite, non-negative radiance. Pictures wider than 2048 texels are box-filtered down. Throws Error.
Environment loadEnvironment(const std::filesystem::path& file, std::vector<std::string>& warnings);

} // namespace scene
