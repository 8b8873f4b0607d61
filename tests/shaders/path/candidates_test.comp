#version 460
#extension GL_GOOGLE_include_directive : require
// All paths of path trees, as the product offers them to reservoirs; single random numbers can be replaced.
#include "lib/frame.glsl"
#include "shifts.h"
layout(local_size_x = 64) in;
layout(set = SET_PASS, binding = 1, std430) readonly buffer Trees { Tree trees[]; };
layout(set = SET_PASS, binding = 2, std430) writeonly buffer Offered { OfferedPath offered[]; }; // SHIFT_PATHS a tree

uvec4 replacedBlock(PathSeed seed, uint block, uvec2 key)
{
    uvec4 random = randomBlock(seed, block, key);
    for (uint i = 0u; i < 2u; ++i) {
        uvec4 replaced = trees[gl_GlobalInvocationID.x].replaced[i];
        if (replaced.w == block) random.xyz = replaced.xyz;
    }
    return random;
}
#define randomBlock replacedBlock
#include "candidates.glsl"

uint endingOf(PathSample y)
{
    if (techniqueOf(y.pathId) == BY_SCATTER) return lightVertex.kept.triangle == NO_HIT ? SKY_MET : LAMP_MET;
    Surface anywhere; // the kind of light does not depend on it
    anywhere.position = vec3(0.0);
    anywhere.geometricNormal = vec3(0.0);
    anywhere.offset = 0.0;
    LightSample light = sampleLight(pathRandom(y.seed, scatteringsOf(y.pathId), PURPOSE_LIGHT), anywhere);
    return light.dirac ? DIRAC_SAMPLED : light.infinite ? SKY_SAMPLED : LAMP_SAMPLED;
}

bool seeks(uint pathId) { return true; }
bool seeksBeyond(uint k) { return true; }
void offer(PathSample y, vec3 f, float density)
{
    Reconnection r = y.reconnection;
    offered[gl_GlobalInvocationID.x * SHIFT_PATHS + y.pathId - makePathId(1u, BY_LIGHT)] =
        OfferedPath(y.seed.frame, y.seed.pixel, y.pathId, y.reconnectionIndex, r.triangle, density, r.barycentric,
                    vec4(r.direction, r.lightPdf), vec4(r.suffix, float(endingOf(y))), vec4(f, 0.0));
}

void main()
{
    if (gl_GlobalInvocationID.x >= uint(trees.length())) return;
    Tree tree = trees[gl_GlobalInvocationID.x];
    vec3 emission;
    vec3 albedo;
    offerCandidates(PathSeed(tree.seedFrame, tree.seedPixel), uvec2(tree.pixel % frame.width, tree.pixel / frame.width), emission,
                    albedo);
    countCandidates();
}
