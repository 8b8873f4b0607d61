#version 460
#extension GL_GOOGLE_include_directive : require
// Schlick's weight of given cosines.
#include "lib/ggx.glsl"
#include "shared/types.h"
layout(local_size_x = 64) in;

layout(set = SET_PASS, binding = 0, std430) readonly buffer Cosines { float cosines[]; };
layout(set = SET_PASS, binding = 1, std430) writeonly buffer Results { float results[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < cosines.length()) results[i] = schlickWeight(cosines[i]);
}
