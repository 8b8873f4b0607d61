#version 460
#extension GL_GOOGLE_include_directive : require
// Evaluates or samples the scattering at a point of the scene's first triangle.
#include "lib/random.glsl"
#include "scene/bindings.glsl"
layout(local_size_x = 64) in;

// Beyond the variants', which end far below.
layout(constant_id = 100) const bool SAMPLE = false;

layout(set = SET_PASS, binding = 0, std430) readonly buffer View { vec4 view; }; // w_o
layout(set = SET_PASS, binding = 1, std430) readonly buffer Directions { vec4 directions[]; }; // to evaluate
layout(set = SET_PASS, binding = 2, std430) writeonly buffer Results { vec4 results[]; };
// Two rows a thread. Evaluated: f |cos|, density; 0. Sampled: weight, density; direction, 1 when Dirac.

#include "scene/bsdf.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(results.length()) / 2u) return;
    Bsdf bsdf = makeBsdf(loadSurface(0u, vec2(0.25), view.xyz), view.xyz);
    if (SAMPLE) {
        uvec4 bits = pcg4d(uvec4(i, 5u, 6u, 7u));
        Scatter scatter = sampleBsdf(bsdf, vec3(unitFloat(bits.x), unitFloat(bits.y), unitFloat(bits.z)));
        results[2u * i] = vec4(scatter.weight, scatter.pdf);
        results[2u * i + 1u] = vec4(scatter.direction, float(scatter.dirac));
    } else {
        vec3 wi = directions[i].xyz;
        float pdf;
        vec3 f = evaluate(bsdf, wi * bsdf.frame, wi, pdf);
        results[2u * i] = vec4(f, pdf);
        results[2u * i + 1u] = vec4(0.0);
    }
}
