// The paths that a pixel's reservoirs choose from: those of one new path tree. With integrand.glsl all that resampling
// knows of light transport; tests put a closed-form integrand in place of both.
#ifndef SHADERS_PATH_CANDIDATES_GLSL
#define SHADERS_PATH_CANDIDATES_GLSL

#include "path/primary_hit.glsl"
#include "path/walk.glsl"

// Defined by the including stage: takes a path that carries light. f is its contribution in primary sample space, that is
// over the density that drew it; f times `density` is f(Y), in the measure that shifts preserve.
void offer(PathSample y, vec3 f, float density);

PathSeed candidateSeed;

bool visit(Vertex x) { return true; }
bool wants(uint leaf) { return true; }
bool goesOn(uint k) { return k < MAX_BOUNCES || HAS_REACHABLE_LIGHT; }
void emit(uint leaf, vec3 f, Ending e)
{
    float density;
    PathSample y = cutPath(candidateSeed, leaf, e, density);
    offer(y, f, density);
}

// False when the primary ray left the scene: nothing to integrate. `emission` is what the pixel sees directly.
bool offerCandidates(PathSeed seed, uvec2 pixel, out vec3 emission)
{
    candidateSeed = seed;
    PrimaryHit hit = loadPrimaryHit(pixel);
    if (hit.seen) {
        footprint = footprintOf(frame.camera, hit.s.position, hit.s.geometricNormal, hit.wo);
        walk(hit.s, hit.wo, seed);
    }
    emission = hit.emission;
    return hit.seen;
}

void countCandidates()
{
    addToCounter(COUNTER_BOUNCE, tracedRays);
    addToCounter(COUNTER_SHADOW, shadowRays);
}

#endif
