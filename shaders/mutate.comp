#version 460
#extension GL_GOOGLE_include_directive : require
// Between stages 1 and 2 where history's domains are not this frame's: walks a new path in each, for the samples it holds.
// (Where they are the same, canonical proposes what it walks in any case.)
#define STAGE STAGE_MUTATE
#include "lib/frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
TABLE_INOUT(SET_PASS, 1, History);
TABLE_INOUT(SET_PASS, 2, HistoryPaths);

#include "candidates.glsl"
#include "restir/mutation.glsl"

void offer(PathSample x, vec3 f, float density)
{
    f = finiteOrCounted(f, STAGE);
    propose(x, f, finiteOrCounted(f * density, STAGE));
}

bool seeks(uint pathId)
{
    bool wanted = false;
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) wanted = wanted || sought[c] == pathId;
    return wanted;
}

bool seeksBeyond(uint k)
{
    bool wanted = false;
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) wanted = wanted || sought[c] > makePathId(k, BY_LIGHT);
    return wanted;
}

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= frame.width || at.y >= frame.height) return;
    uint pixel = at.y * frame.width + at.x;

    Domain there = makeDomain(pixel, true);
    if (!there.seen) return;
    beginMutation(pixel);
    enterWorld(true);
    offerCandidatesOf(there, PathSeed(frame.frame | SEED_OF_PROPOSAL, pixel));
    enterWorld(false);
    endMutation(pixel);
    countCandidates();
}
