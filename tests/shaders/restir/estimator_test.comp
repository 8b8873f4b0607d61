#version 460
#extension GL_GOOGLE_include_directive : require
// The parts of COLOR_VARIATE's estimate, a thread each: chains of its mean at rest, and ratios of albedos.
#include "restir/estimator.glsl"
layout(local_size_x = 64) in;
struct Chain {
    vec4 estimate; // xyz: A
    uint generator;
    uint frames; // so far
    uint padding0;
    uint padding1;
};
const uint FRAMES = 32768u; // of a dispatch
layout(set = SET_PASS, binding = 0, std430) buffer Chains { Chain chains[]; };
layout(set = SET_PASS, binding = 1, std430) readonly buffer Albedos { vec4 albedos[]; }; // in pairs: here, there
layout(set = SET_PASS, binding = 2, std430) writeonly buffer Ratios { vec4 ratios[]; };

// Dark but for one frame in 64.
float sampleOf(uint generator) { return generator >> 26u == 0u ? 64.0 : 0.0; }

uint advanced(uint generator) { return generator * 1664525u + 1013904223u; }

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < uint(ratios.length())) {
        uint here = packedAlbedo(albedos[2u * i].xyz);
        uint there = packedAlbedo(albedos[2u * i + 1u].xyz);
        ratios[i] = vec4(albedoRatio(here, there), 0.0);
    }
    if (i >= uint(chains.length())) return;
    Chain chain = chains[i];
    for (uint n = 0u; n < FRAMES; ++n) {
        chain.generator = advanced(chain.generator);
        vec3 value = vec3(sampleOf(chain.generator));
        uvec3 random = decisionRandom(i, chain.frames).xyz;
        float newShare = share(1.0, 1.0, float(chain.frames));
        vec3 change = newShare * (value - chain.estimate.xyz);
        chain.estimate.xyz = chain.frames == 0u ? value : roundedAtRandom(chain.estimate.xyz, change, random);
        ++chain.frames;
    }
    chains[i] = chain;
}
