#version 460
#extension GL_GOOGLE_include_directive : require
// Stage 1. Walks one new path tree a pixel and offers every path to all of the pixel's reservoirs (Algorithm 1).
#define STAGE STAGE_CANONICAL
#include "lib/frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
TABLE_OUT(SET_PASS, 1, Reservoirs);
TABLE_OUT(SET_PASS, 2, ReservoirPaths);
TABLE_OUT(SET_PASS, 3, Color); // seen directly; gather adds the rest
TABLE_OUT(SET_PASS, 4, MergedColor); // what the path tracer would add, and the albedo
layout(set = SET_PASS, binding = 5, std430) writeonly buffer Confidences { uint confidences[]; };
TABLE_INOUT(SET_PASS, 6, History);
TABLE_INOUT(SET_PASS, 7, HistoryPaths);

#include "candidates.glsl"
#include "restir/mutation.glsl"
STORE_RESERVOIRS(Reservoirs, Reservoirs, ReservoirPaths)

// At rest what this frame walks are paths of history's domain, too.
const bool MUTATES = MUTATION == MUTATION_FREE && SAME_VIEW;

Reservoir canonical[MAX_RESERVOIRS];
vec3 allPaths = vec3(0.0); // of the tree: what the path tracer would add

void offer(PathSample y, vec3 f, float density)
{
    f = finiteOrCounted(f, STAGE);
    vec3 stored = finiteOrCounted(f * density, STAGE);
    if (MUTATES) propose(y, f, stored);
    if (COLOR_READING != COLOR_CHOSEN) allPaths += f;
    float u = decisionNumber(y.seed.pixel, STREAM_CANONICAL + y.pathId); // one for all reservoirs
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        if (!consider(canonical[c], targetOf(c, f), u)) continue;
        canonical[c].chosen = y;
        canonical[c].f = stored;
    }
}
bool seeks(uint pathId) { return true; }
bool seeksBeyond(uint k) { return true; }

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= frame.width || at.y >= frame.height) return;
    uint pixel = at.y * frame.width + at.x;

    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) canonical[c] = EMPTY;
    if (MUTATES) beginMutation(pixel);
    vec3 emission;
    vec3 albedo;
    bool seen = offerCandidates(PathSeed(frame.frame, pixel), at, emission, albedo);
    STORE(Color, pixel, rowOf(finiteOrCounted(emission, STAGE)));
    uint word = COLOR_READING == COLOR_VARIATE ? packedAlbedo(finiteOrCounted(albedo, STAGE)) : 0u;
    if (COLOR_READING != COLOR_CHOSEN) STORE(MergedColor, pixel, rowOf(allPaths, word));
    storeReservoirs(pixel, canonical);
    if (MUTATES) endMutation(pixel);
    confidences[pixel] = seen ? 1u : 0u; // also when no path carried light: that is news too
    countCandidates();
}
