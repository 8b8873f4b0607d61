#version 460
#extension GL_GOOGLE_include_directive : require
// A million frames of a resting camera, one chain per thread: weight sums are drawn by a generator that C++ has, too.
#include "restir/reservoir.glsl"
#include "shared/types.h"
layout(local_size_x = 64) in;
layout(set = SET_PASS, binding = 0, std430) readonly buffer Chains { uvec2 chains[]; }; // start of the generator, frames
layout(set = SET_PASS, binding = 1, std430) writeonly buffer Ends { vec4 ends[]; };     // S, carry, w_n, S_n of the last

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(chains.length())) return;
    uint state = chains[i].x;
    Reservoir history = EMPTY;
    float weight = 0.0;
    float single = 0.0;
    for (uint frame = 0u; frame < chains[i].y; ++frame) {
        state = state * 1664525u + 1013904223u;
        single = float(state >> 8u) * exp2(-23.0);
        Reservoir here = EMPTY;
        here.weightSum = single;
        if (frame > 0u) mergeHistory(here, history, 1.0, 1.0, 1.0, float(frame), 0.5, weight);
        history = here;
    }
    ends[i] = vec4(history.weightSum, history.carry, weight, single);
}
