// The toy world on the GPU: toy.h says what it is.
#ifndef TESTS_SHADERS_TOY_TOY_GLSL
#define TESTS_SHADERS_TOY_TOY_GLSL

#include "lib/frame.glsl"
#include "restir/reservoir.glsl"
#include "toy.h"

layout(set = SET_PASS, binding = 0, std430) readonly buffer Domains {
    vec4 cells[TOY_PATHS * TOY_CELLS];
    uint periodFrames; // after which the domains come again
    uint padding[3];
    ToyDomain domains[]; // of one run, frame by frame
};

uint runPixels() { return frame.width * frame.runHeight; }

ToyDomain toyDomain(uint pixel, bool previous)
{
    uint number = (frame.frame + (previous ? periodFrames - 1u : 0u)) % periodFrames;
    return domains[number * runPixels() + pixel % runPixels()];
}

float density(ToyDomain d, float x) { return 1.0 + d.slope * (2.0 * x - 1.0); }

// The x that the path's random number draws: u = x + slope (x^2 - x). The runs of a group have the same numbers but for a
// rotation, which leaves each of them uniform and makes the mean over a group a good deal more precise.
float drawn(ToyDomain d, PathSeed seed, uint pathId)
{
    uint run = seed.pixel / runPixels();
    PathSeed groups = PathSeed(seed.frame, seed.pixel - run % TOY_GROUP * runPixels());
    float u0 = unitFloat(randomBlock(groups, STREAM_PATH + 2u * pathId, uvec2(frame.key0, frame.key1)).x);
    float u = fract(u0 + float(run % TOY_GROUP) / float(TOY_GROUP));
    float b = 1.0 - d.slope;
    return min(2.0 * u / (b + sqrt(b * b + 4.0 * d.slope * u)), 0.99999994);
}

bool canBeKept(ToyDomain d, float x) { return SHIFT_MAP != SHIFT_REPLAY && fract(4.0 * x + d.phase) >= 0.25; }

// What of h depends on x alone is the suffix of a kept path, in two parts.
vec3 suffixOf(uint pathId, float x) { return cells[(pathId - TOY_FIRST_PATH) * TOY_CELLS + uint(x * float(TOY_CELLS))].rgb; }
float ending(float x) { return 1.0 + 2.0 * x; }
vec3 value(ToyDomain d, float x, vec3 suffix, float end)
{
    return abs(x - d.occluder) < TOY_OCCLUDER_SIZE ? vec3(0.0) : d.albedo.rgb * suffix * end;
}

#endif
