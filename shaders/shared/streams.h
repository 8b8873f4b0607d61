// Which random numbers are whose: blocks of four 32-bit numbers, addressed by (frame, pixel, block, key).
// Random access: a replay draws only what it needs, and a new purpose never shifts another's numbers.
#ifndef SHADERS_SHARED_STREAMS_H
#define SHADERS_SHARED_STREAMS_H

#include "shared/types.h"

SHARED_BEGIN

// Path numbers, of vertex x_k (k >= 1): PATH_STREAM + 2 k (+ 1).
SHARED_CONST uint STREAM_CAMERA = 0u;   // pixel offset x, y; -; alpha seed of the camera ray
SHARED_CONST uint STREAM_PATH = 0u;     // k >= 1, so blocks 2.. are free of the camera's
SHARED_CONST uint PURPOSE_LIGHT = 0u;   // light pick; point on the light (2); alpha seed of the shadow ray
SHARED_CONST uint PURPOSE_SCATTER = 1u; // lobe; direction (2); alpha seed of the scattered ray
// Selection numbers, keyed by the pixel and frame that select, never by a stored seed.
SHARED_CONST uint STREAM_CANONICAL = 0x10000u; // + path id
SHARED_CONST uint STREAM_TEMPORAL = 0x20000u;
SHARED_CONST uint STREAM_SPATIAL = 0x30000u;   // + slot
SHARED_CONST uint STREAM_NEIGHBORS = 0x40000u; // + slot
SHARED_CONST uint STREAM_MUTATION = 0x50000u;

// Bit of a seed's frame: of paths that were walked in the domain of the frame before. Frames do not reach it.
SHARED_CONST uint SEED_OF_PROPOSAL = 0x80000000u;

SHARED_END
#endif
