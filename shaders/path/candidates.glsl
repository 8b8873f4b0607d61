// The paths that a pixel's reservoirs choose from: those of one new path tree.
#ifndef SHADERS_PATH_CANDIDATES_GLSL
#define SHADERS_PATH_CANDIDATES_GLSL

#include "path/domain.glsl"
#include "path/walk.glsl"

PathSeed candidateSeed;

bool visit(Vertex x) { return true; }
bool wants(uint pathId) { return seeks(pathId); }
bool goesOn(uint k) { return (k < MAX_BOUNCES || HAS_REACHABLE_LIGHT) && seeksBeyond(k); }
void emit(uint pathId, vec3 f, Ending e)
{
    float density;
    PathSample y = sampleOf(candidateSeed, pathId, e, density);
    offer(y, f, density);
}

// False when the primary ray left the scene: nothing to integrate. `emission` is what the pixel sees directly, `albedo` that
// of the surface.
bool offerCandidates(PathSeed seed, uvec2 at, out vec3 emission, out vec3 albedo)
{
    candidateSeed = seed;
    PrimaryHit hit = loadPrimaryHit(at);
    albedo = vec3(0.0);
    if (hit.seen) {
        footprint = footprintOf(frame.camera, hit.s.position, hit.s.geometricNormal, hit.wo);
        Bsdf bsdf = makeBsdf(hit.s, hit.wo);
        albedo = albedoOf(bsdf);
        walk(hit.s, bsdf, hit.wo, seed);
    }
    emission = hit.emission;
    return hit.seen;
}

// The same from the first vertex of a domain, in the world that has been entered.
void offerCandidatesOf(Domain d, PathSeed seed)
{
    candidateSeed = seed;
    footprint = d.footprint;
    walk(loadSurface(d.triangle, d.barycentric, d.wo), d.wo, seed);
}

void countCandidates()
{
    addToCounter(COUNTER_BOUNCE, tracedRays);
    addToCounter(COUNTER_SHADOW, shadowRays);
}

#endif
