// In place of path/candidates.glsl: each path of the toy.
#include "toy.glsl"

const vec3 TOY_EMISSION = vec3(0.5, 0.25, 0.125);

void offer(PathSample y, vec3 f, float density);

bool offerCandidates(PathSeed seed, uvec2 pixel, out vec3 emission, out vec3 albedo)
{
    emission = TOY_EMISSION;
    ToyDomain d = toyDomain(pixel.y * frame.width + pixel.x, false);
    albedo = d.albedo.rgb;
    if (d.seen == 0u) return false;
    for (uint pathId = 0u; pathId < TOY_PATHS; ++pathId) {
        float x = drawn(d, seed, pathId);
        vec3 h = value(d, x, suffixOf(pathId, x), ending(x));
        if (h == vec3(0.0)) continue;
        float p = density(d, x);
        bool kept = canBeKept(d, x);
        offer(PathSample(seed, pathId, kept ? 2u : 0u,
                         Reconnection(pathId, vec2(x, 0.0), ending(x), vec3(0.0, x, 0.0), suffixOf(pathId, x))),
              h / p, kept ? p : 1.0);
    }
    return true;
}

void countCandidates() {}
