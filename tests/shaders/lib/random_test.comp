#version 460
#extension GL_GOOGLE_include_directive : require
// pcg4d of given words, or blocks of random numbers of given (frame, pixel, block, key).
#include "lib/random.glsl"
#include "shared/types.h"
layout(local_size_x = 64) in;

layout(constant_id = 0) const bool BLOCKS = false;

layout(set = SET_PASS, binding = 0, std430) readonly buffer Inputs { uvec4 inputs[]; };
layout(set = SET_PASS, binding = 1, std430) writeonly buffer Outputs { uvec4 outputs[]; };
layout(set = SET_PASS, binding = 2, std430) writeonly buffer Units { float units[]; }; // unitFloat() of the first

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(inputs.length())) return;
    uvec4 v = inputs[i];
    uvec4 bits = BLOCKS ? randomBlock(PathSeed(v.x, v.y), v.z, uvec2(v.w, 77u)) : pcg4d(v);
    outputs[i] = bits;
    units[i] = unitFloat(BLOCKS ? bits.x : v.x);
}
