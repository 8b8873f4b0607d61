#version 460
#extension GL_GOOGLE_include_directive : require
// found[i] = element indices[i] of the table.
#include "lib/lanes.glsl"
#include "shared/types.h"
layout(local_size_x = 64) in;
TABLE(SET_SCENE, 0, Elements);
layout(set = SET_PASS, binding = 0, std430) readonly buffer Indices { uint indices[]; };
layout(set = SET_PASS, binding = 1, std430) writeonly buffer Found { uvec4 found[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < indices.length()) found[i] = FETCH(Elements, indices[i]);
}
