// In place of path/candidates.glsl: each path of the toy.
#include "domain.glsl"

const vec3 TOY_EMISSION = vec3(0.5, 0.25, 0.125);

void offer(PathSample y, vec3 f, float density);

void offerCandidatesOf(Domain domain, PathSeed seed)
{
    ToyDomain d = domain.toy;
    for (uint pathId = TOY_FIRST_PATH; pathId < TOY_FIRST_PATH + TOY_PATHS; ++pathId) {
        float x = drawn(d, seed, pathId);
        vec3 h = value(d, x, suffixOf(pathId, x), ending(x));
        if (h == vec3(0.0)) continue;
        float p = density(d, x);
        bool kept = canBeKept(d, x);
        offer(PathSample(seed, pathId, kept ? 2u : 0u,
                         Reconnection(pathId, vec2(x, 0.0), ending(x), vec3(0.0, x, 0.0), suffixOf(pathId, x)), kept ? p : 1.0),
              h / p, kept ? p : 1.0);
    }
}

bool offerCandidates(PathSeed seed, uvec2 pixel, out vec3 emission, out vec3 albedo)
{
    Domain d = makeDomain(pixel.y * frame.width + pixel.x, false);
    emission = TOY_EMISSION;
    albedo = d.toy.albedo.rgb;
    if (d.seen) offerCandidatesOf(d, seed);
    return d.seen;
}

void countCandidates() {}
