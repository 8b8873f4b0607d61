#version 460
#extension GL_GOOGLE_include_directive : require
// Stage 1. Walks one new path tree a pixel and offers every path to all of the pixel's reservoirs (Algorithm 1).
#define STAGE STAGE_CANONICAL
#include "lib/frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_PASS, binding = 1, std430) buffer Reservoirs { uvec4 reservoirs[]; };
layout(set = SET_PASS, binding = 2, std430) buffer ReservoirPaths { uvec4 reservoirPaths[]; };
layout(set = SET_PASS, binding = 3, std430) writeonly buffer Color { vec4 color[]; }; // seen directly; gather adds the rest
layout(set = SET_PASS, binding = 4, std430) writeonly buffer MergedColor { vec4 mergedColor[]; };

#include "candidates.glsl"
#include "restir/estimator.glsl"
#include "restir/reservoir_store.glsl"
STORE_RESERVOIRS(Reservoirs, reservoirs, reservoirPaths)

Reservoir canonical[MAX_RESERVOIRS];
vec3 allPaths = vec3(0.0); // of the tree: what the path tracer would add

void offer(PathSample y, vec3 f, float density)
{
    f = finiteOrCounted(f, STAGE);
    vec3 stored = finiteOrCounted(f * density, STAGE);
    if (COLOR_READING == COLOR_WEIGHTED) allPaths += f;
    float u = decisionFloat(decisionRandom(y.seed.pixel, STREAM_CANONICAL + y.leaf).x); // one for all reservoirs
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        if (!consider(canonical[c], targetOf(c, f), u)) continue;
        canonical[c].chosen = y;
        canonical[c].f = stored;
    }
}

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width || pixel.y >= frame.height) return;
    uint index = pixel.y * frame.width + pixel.x;

    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) canonical[c] = EMPTY;
    vec3 emission;
    bool seen = offerCandidates(PathSeed(frame.frame, index), pixel, emission);
    color[index] = vec4(finiteOrCounted(emission, STAGE), 0.0);
    if (COLOR_READING == COLOR_WEIGHTED) mergedColor[index] = vec4(allPaths, 0.0);
    storeReservoirs(index, canonical);
    storeReservoirsConfidence(index, seen ? 1u : 0u); // also when no path carried light: that is news too
    countCandidates();
}
