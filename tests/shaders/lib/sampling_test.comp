#version 460
#extension GL_GOOGLE_include_directive : require
// Samples of one routine from hashed numbers.
#include "lib/ggx.glsl"
#include "lib/random.glsl"
#include "shared/types.h"
layout(local_size_x = 64) in;

const uint COSINE = 0u;
const uint TRIANGLE = 1u;
const uint VISIBLE_NORMAL = 2u;
const uint CIRCLE = 3u; // a point, its angle in turns, and that found again from a point of another length
const uint PICK = 4u;   // a third of an index below 3 * 2^30, and what is left over
layout(constant_id = 0) const uint ROUTINE = COSINE;

layout(set = SET_PASS, binding = 0, std430) readonly buffer Parameters { vec4 parameters[]; }; // w_o, alpha_g
layout(set = SET_PASS, binding = 1, std430) writeonly buffer Samples { vec4 samples[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(samples.length())) return;
    uvec4 bits = pcg4d(uvec4(i, 1u, 2u, 3u));
    vec2 u = vec2(unitFloat(bits.x), unitFloat(bits.y));
    vec4 p = parameters[0];
    if (ROUTINE == COSINE) samples[i] = vec4(sampleCosineHemisphere(u), 0.0);
    if (ROUTINE == TRIANGLE) samples[i] = vec4(sampleTriangle(u), 0.0, 0.0);
    if (ROUTINE == VISIBLE_NORMAL) samples[i] = vec4(sampleVisibleNormal(p.xyz, p.w, u), 0.0);
    if (ROUTINE == CIRCLE) samples[i] = vec4(unitCircle(u.x), u.x, turnsOf(exp(10.0 * u.y - 5.0) * unitCircle(u.x)));
    if (ROUTINE == PICK) {
        float rest;
        uint index = pick(bits.xy, 3u << 30u, rest);
        samples[i] = vec4(float(index % 3u), rest, 0.0, 0.0);
    }
}
