// What every stage of a frame knows (set 0).
#ifndef SHADERS_SHARED_FRAME_H
#define SHADERS_SHARED_FRAME_H

#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST uint MAX_RESERVOIRS = 4u; // of a pixel: one for each row of the estimator's table

SHARED_CONST uint NO_NEIGHBOR = 0xffffffffu;

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
    uint height; // pixels, of all runs
    uint frame;  // index since the last reset; with the pixel it is the path's seed
    uint key0;   // of the random numbers: a hash of the user's seed
    uint key1;
    uint slice;           // which half of Surfaces is this frame's: 0 or 1
    uint previousSlice;   // and which is the previous frame's: the same one while the camera rests
    uint maxConfidence;   // M_c, frames
    uint neighborCount;   // K
    float neighborRadius; // pixels
    uint runHeight;       // pixels, of one run's picture: independent runs lie below each other
    uint world;           // which of the scene's two worlds this frame shows: 0 or 1
    uint colorConfidence; // the most that history counts in COLOR_VARIATE's estimate, frames
    uint padding0;
    uint padding1;
    uint padding2;
    vec4 target[MAX_RESERVOIRS];  // xyz: p_hat_c(f) = <target[c], f>
    vec4 resolve[MAX_RESERVOIRS]; // xyz: color = sum over c of resolve[c] f(Y_c) W_c
};

// All stages that a frame can have, in their order: X(index, NAME, "shader").
#define FRAME_STAGES(X)                                                                                                \
    X(0u, PRIMARY, "primary")                                                                                          \
    X(1u, PATH_TRACE, "path_trace")                                                                                    \
    X(2u, CANONICAL, "canonical")                                                                                      \
    X(3u, MUTATE, "mutate")                                                                                            \
    X(4u, TEMPORAL, "temporal")                                                                                        \
    X(5u, SPATIAL_TRACE, "spatial_trace")                                                                              \
    X(6u, SPATIAL_GATHER, "spatial_gather")                                                                            \
    X(7u, ACCUMULATE, "accumulate")

// Device counters, 64 bits as (low, high) pairs: rays by kind, shifts by outcome, non-finite values by stage.
SHARED_CONST uint COUNTER_PRIMARY = 0u;
SHARED_CONST uint COUNTER_BOUNCE = 1u;
SHARED_CONST uint COUNTER_SHADOW = 2u;
SHARED_CONST uint COUNTER_REPLAY = 3u;       // rays of replayed paths, to the next vertex or to a light
SHARED_CONST uint COUNTER_RECONNECTION = 4u; // rays that ask whether two vertices see each other
SHARED_CONST uint RAY_KINDS = 5u;
SHARED_CONST uint COUNTER_SHIFT = 5u;        // + outcome
SHARED_CONST uint SHIFT_DONE = 0u;           // the path exists in the other domain and carries light there
SHARED_CONST uint SHIFT_ENDED = 1u;          // the replay left the scene, was absorbed or met no light
SHARED_CONST uint SHIFT_JOINED_EARLIER = 2u; // the replay could reconnect before the path itself does: not invertible
SHARED_CONST uint SHIFT_NOT_JOINABLE = 3u;   // too near or too smooth to reconnect there
SHARED_CONST uint SHIFT_HIDDEN = 4u;         // something stands between the vertices
SHARED_CONST uint SHIFT_DARK = 5u;           // joined, but nothing is scattered that way
SHARED_CONST uint SHIFT_OUTCOMES = 6u;
SHARED_CONST uint COUNTER_HELD = 11u;      // pixels of which every reservoir holds a sample, when there are several
SHARED_CONST uint COUNTER_TREES = 12u;     // different path trees among those reservoirs
SHARED_CONST uint COUNTER_PROPOSED = 13u;  // mutations of samples that history holds
SHARED_CONST uint COUNTER_ACCEPTED = 14u;  // and how many of them replaced theirs
SHARED_CONST uint COUNTER_NONFINITE = 15u; // + stage
#define DECLARE_STAGE(INDEX, NAME, SHADER) SHARED_CONST uint STAGE_##NAME = INDEX;
FRAME_STAGES(DECLARE_STAGE)
#undef DECLARE_STAGE
SHARED_CONST uint STAGE_COUNT = STAGE_ACCUMULATE + 1u; // the last
SHARED_CONST uint COUNTER_COUNT = COUNTER_NONFINITE + STAGE_COUNT;

SHARED_END
#ifdef __cplusplus
static_assert(sizeof(shared::CameraUniform) == 64 && sizeof(shared::FrameUniform) == 320);
static_assert(shared::COUNTER_SHIFT == shared::RAY_KINDS);
static_assert(shared::COUNTER_HELD == shared::COUNTER_SHIFT + shared::SHIFT_OUTCOMES);
#endif
#endif
