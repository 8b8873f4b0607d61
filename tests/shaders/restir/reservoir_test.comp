#version 460
#extension GL_GOOGLE_include_directive : require
// Merges one reservoir and its history per thread.
#include "restir/reservoir.glsl"
#include "shared/types.h"
layout(local_size_x = 64) in;
// Two rows a thread: S_n, S_h, rho, historyRho | c_n, c_h, u, carry of the history.
layout(set = SET_PASS, binding = 0, std430) readonly buffer Merges { vec4 merges[]; };
layout(set = SET_PASS, binding = 1, std430) writeonly buffer Merged { vec4 merged[]; }; // S', carry', 1 when history is chosen, w_n

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(merges.length()) / 2u) return;
    vec4 a = merges[2u * i];
    vec4 b = merges[2u * i + 1u];
    Reservoir here = EMPTY;
    here.weightSum = a.x;
    Reservoir history = EMPTY;
    history.weightSum = a.y;
    history.carry = b.w;
    float weight;
    bool chosen = mergeHistory(here, history, a.z, a.w, b.x, b.y, b.z, weight);
    merged[i] = vec4(here.weightSum, here.carry, chosen ? 1.0 : 0.0, weight);
}
