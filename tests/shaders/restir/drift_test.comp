#version 460
#extension GL_GOOGLE_include_directive : require
// Many frames of a resting camera, one chain per thread: weight sums are drawn by a generator that C++ has, too. Mesa's CPU
// driver leaves loops after 65536 turns, so that chains go on in the next dispatch.
#include "restir/reservoir.glsl"
#include "shared/types.h"
layout(local_size_x = 64) in;
struct Chain {
    uint generator; // state
    uint frames;    // done
    float weightSum;
    float carry;
    float weight; // w_n of the last frame,
    float single; // and its S_n
    uint padding0;
    uint padding1;
};
const uint FRAMES = 32768u; // of a dispatch
layout(set = SET_PASS, binding = 0, std430) buffer Chains { Chain chains[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(chains.length())) return;
    Chain chain = chains[i];
    for (uint n = 0u; n < FRAMES; ++n) {
        chain.generator = chain.generator * 1664525u + 1013904223u;
        chain.single = float(chain.generator >> 8u) * exp2(-23.0);
        Reservoir here = EMPTY;
        here.weightSum = chain.single;
        Reservoir history = EMPTY;
        history.weightSum = chain.weightSum;
        history.carry = chain.carry;
        if (chain.frames > 0u) mergeHistory(here, history, 1.0, 1.0, 1.0, float(chain.frames), 0.5, chain.weight);
        chain.weightSum = here.weightSum;
        chain.carry = here.carry;
        ++chain.frames;
    }
    chains[i] = chain;
}
