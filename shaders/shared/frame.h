// What every stage of a frame knows (set 0).
#ifndef SHADERS_SHARED_FRAME_H
#define SHADERS_SHARED_FRAME_H

#include "shared/types.h"

SHARED_BEGIN

// A pinhole or parallel camera in scaled scene coordinates. A picture point is (x, y) in [-1, 1]^2, y up.
struct CameraUniform {
    vec4 position; // xyz
    vec4 right;    // xyz: half the picture's width at distance 1 (perspective), or in scaled units (orthographic)
    vec4 up;       // xyz: half the height, likewise
    vec4 forward;  // xyz: unit
};

struct FrameUniform {
    CameraUniform camera;
    CameraUniform previousCamera;
    uint width;  // pixels
    uint height; // pixels
    uint frame;  // index since the last reset; with the pixel it is the path's seed
    uint key0;   // of the random numbers: a hash of the user's seed
    uint key1;
    uint padding0;
    uint padding1;
    uint padding2;
};

// Device counters, 64 bits as (low, high) pairs.
SHARED_CONST uint COUNTER_PRIMARY = 0u;
SHARED_CONST uint COUNTER_BOUNCE = 1u;
SHARED_CONST uint COUNTER_SHADOW = 2u;
SHARED_CONST uint COUNTER_REPLAY = 3u;
SHARED_CONST uint COUNTER_RECONNECTION = 4u;
SHARED_CONST uint COUNTER_NONFINITE = 5u; // + stage
SHARED_CONST uint STAGE_PRIMARY = 0u;
SHARED_CONST uint STAGE_PATH_TRACE = 1u;
SHARED_CONST uint STAGE_CANONICAL = 2u;
SHARED_CONST uint STAGE_TEMPORAL = 3u;
SHARED_CONST uint STAGE_SPATIAL_TRACE = 4u;
SHARED_CONST uint STAGE_SPATIAL_GATHER = 5u;
SHARED_CONST uint STAGE_ACCUMULATE = 6u;
SHARED_CONST uint STAGE_COUNT = 7u;
SHARED_CONST uint COUNTER_COUNT = 12u; // COUNTER_NONFINITE + STAGE_COUNT

SHARED_END
#ifdef __cplusplus
static_assert(sizeof(shared::CameraUniform) == 64 && sizeof(shared::FrameUniform) == 160);
static_assert(shared::COUNTER_COUNT == shared::COUNTER_NONFINITE + shared::STAGE_COUNT);
#endif
#endif
