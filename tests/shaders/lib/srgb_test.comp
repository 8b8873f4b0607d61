#version 460
#extension GL_GOOGLE_include_directive : require
// All 8-bit values decoded.
#include "lib/srgb.glsl"
#include "shared/types.h"
layout(local_size_x = 64) in;

layout(set = SET_PASS, binding = 0, std430) writeonly buffer Results { float results[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= 256u) return;
    results[i] = linearFromSrgb(vec3(float(i) / 255.0)).x;
}
