#version 460
#extension GL_GOOGLE_include_directive : require
// Every thread reads what another thread wrote before: to[i] = from[(i + stride) % count] + increment.
#include "shared/types.h"
layout(local_size_x = 64) in;
layout(set = SET_FRAME, binding = 0) uniform Step { uint stride; uint increment; };
layout(set = SET_PASS, binding = 0, std430) readonly buffer From { uint from[]; };
layout(set = SET_PASS, binding = 1, std430) writeonly buffer To { uint to[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= to.length()) return;
    to[i] = from[(i + stride) % from.length()] + increment;
}
