#pragma once
// Environment maps: equirectangular pictures (.exr, .hdr) as light from infinity.

#include <filesystem>

#include "engine/image/image.h"
#include "engine/scene/scene.h"
#include "engine/scene/warnings.h"

namespace scene
{

constexpr uint32_t MAX_ENVIRONMENT_WIDTH = 2048;

// Finite, non-negative radiance, at most 1e12; other values change to the nearest (or 0), with a warning. The picture's
// middle column is +x and +z lies a quarter to its right, as in three.js and Khronos' viewers. Wider pictures than
// MAX_ENVIRONMENT_WIDTH are averaged down, each texel over its solid angle. `what` is for messages.
Environment environmentFrom(const image::Image& picture, const std::string& what, Warnings& warnings);

// Replaces the scene's environment by that of `file`, unless the name is empty, then multiplies its radiance by
// `scale`. Adds to Scene::warnings. Throws Error.
void setEnvironment(Scene& scene, const std::filesystem::path& file, float scale);

} // namespace scene
