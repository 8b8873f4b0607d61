#pragma once
// Small images for test scenes; each is added to the scene's, and its index is returned.

#include <cstdint>

#include "engine/scene/scene.h"

namespace support
{

// Random bytes from `low` to 255.
uint32_t addNoise(scene::Scene& scene, uint32_t width, uint32_t height, int low, uint32_t seed);

// The same with samples of 16 bits.
uint32_t addDeepNoise(scene::Scene& scene, uint32_t width, uint32_t height, int low, uint32_t seed);

uint32_t addBumps(scene::Scene& scene); // a normal map

} // namespace support
