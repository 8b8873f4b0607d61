#pragma once
// A path tracer of the same integral as the shaders, in float64, brute force over the triangles: slow, small, written
// from docs/LIGHT_TRANSPORT.md alone. For scenes of some dozens of triangles.

#include "engine/image/image.h"
#include "engine/scene/scene.h"
#include "passes/settings.h"
#include "tests/support/tile_tests.h"

namespace support
{

// What `settings` (size, camera, maxBounces, pixelFilter, environmentScale) ask for, from `samplesPerPixel` paths per
// pixel, all independent. Equal seeds give equal results, whatever the number of threads.
PixelEstimates reference(const scene::Scene& scene, const passes::Settings& settings, uint64_t samplesPerPixel,
                         uint64_t seed);

} // namespace support
