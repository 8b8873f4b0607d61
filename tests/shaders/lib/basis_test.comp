#version 460
#extension GL_GOOGLE_include_directive : require
// Bases of given normals, and unit vectors unpacked from 32 bits.
#include "lib/basis.glsl"
#include "shared/types.h"
layout(local_size_x = 64) in;

layout(set = SET_PASS, binding = 0, std430) readonly buffer Normals { vec4 normals[]; }; // xyz; w is the packed vector
layout(set = SET_PASS, binding = 1, std430) writeonly buffer Results { vec4 results[]; }; // the columns; unpacked

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(normals.length())) return;
    mat3 basis = basisFromNormal(normals[i].xyz);
    for (int column = 0; column < 3; ++column) results[4u * i + column] = vec4(basis[column], 0.0);
    results[4u * i + 3u] = vec4(octahedralDecode(floatBitsToUint(normals[i].w)), 0.0);
}
