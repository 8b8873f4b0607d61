// The one path walker. It traces the path tree of one seed from a primary hit and reports every light-carrying path to
//     void emit(uint leaf, vec3 f);
// which the including stage defines above the include. f is the path's MIS-weighted contribution over its density: the
// integrand in primary sample space. Sampling, replay and reference differ only in what emit() does.
#ifndef SHADERS_PATH_WALK_GLSL
#define SHADERS_PATH_WALK_GLSL

#include "scene/bsdf.glsl"
#include "scene/camera.glsl"
#include "scene/lights.glsl"

// A leaf of the path tree: the number k of scattering events, and how the light was found.
const uint BY_LIGHT = 0u;   // next-event estimation at x_k
const uint BY_SCATTER = 1u; // the scattered ray of x_k met an emitter or the environment
uint makeLeaf(uint k, uint technique) { return (k << 1u) | technique; }

// Can a scattered ray find light at all? If not, the last one is not traced.
const bool HAS_REACHABLE_LIGHT = HAS_EMISSIVE || HAS_ENVIRONMENT || HAS_UNLIT;

uint bounceRays = 0u;
uint shadowRays = 0u;

uvec4 pathRandom(PathSeed seed, uint k, uint purpose)
{
    return randomBlock(seed, STREAM_PATH + 2u * k + purpose, uvec2(frame.key0, frame.key1));
}

// Is the light sample hidden from the surface?
bool shadowed(Surface s, LightSample l, uint alphaSeed)
{
    ++shadowRays;
    vec3 origin = offsetOrigin(s.position, s.geometricNormal, l.direction);
    if (l.infinite) return occluded(Ray(origin, l.direction, RAY_MAX), alphaSeed);
    vec3 target = l.normal == vec3(0.0) ? l.target : offsetOrigin(l.target, l.normal, -l.direction);
    vec3 d = target - origin;
    float distance = length(d);
    return distance > 0.0 && occluded(Ray(origin, d / distance, distance), alphaSeed);
}

// Surface s is x1 seen from direction wo.
void walk(Surface s, vec3 wo, PathSeed seed, uint maxScatterings)
{
    vec3 throughput = vec3(1.0);
    for (uint k = 1u; k <= maxScatterings; ++k) {
        Bsdf bsdf = makeBsdf(s, wo);
        if (absorbs(bsdf)) return;

        // Light found by next-event estimation: f L / (p_N + p_B), the balance heuristic written without 0/0.
        uvec4 random = pathRandom(seed, k, PURPOSE_LIGHT);
        LightSample light = sampleLight(random, s.position);
        float scatterPdf;
        vec3 f = evaluate(bsdf, light.direction * bsdf.frame, light.direction, scatterPdf);
        vec3 contribution = throughput * f * light.radiance / (light.dirac ? light.pdf : light.pdf + scatterPdf);
        if (contribution != vec3(0.0) && !shadowed(s, light, random.w)) emit(makeLeaf(k, BY_LIGHT), contribution);

        if (k == maxScatterings && !HAS_REACHABLE_LIGHT) return;
        random = pathRandom(seed, k, PURPOSE_SCATTER);
        Scatter scatter = sampleBsdf(bsdf, vec3(unitFloat(random.x), unitFloat(random.y), unitFloat(random.z)));
        throughput *= scatter.weight;
        if (throughput == vec3(0.0)) return;
        ++bounceRays;
        vec3 origin = offsetOrigin(s.position, s.geometricNormal, scatter.direction);
        Hit hit = closestHit(Ray(origin, scatter.direction, RAY_MAX), random.w);

        // Light found by scattering, weighted against next-event estimation.
        float lightDensity = 0.0;
        vec3 emitted = vec3(0.0);
        if (hit.triangle == NO_HIT) {
            if (!HAS_ENVIRONMENT) return;
            vec4 environment = loadEnvironment(scatter.direction);
            emitted = environment.rgb;
            lightDensity = environmentPdf(environment);
        } else {
            vec3 from = s.position;
            wo = -scatter.direction;
            s = loadSurface(hit.triangle, hit.barycentric, wo);
            emitted = s.emission;
            lightDensity = lightPdf(s, from, wo);
        }
        if (emitted != vec3(0.0)) {
            float weight = scatter.dirac ? 1.0 : scatter.pdf / (scatter.pdf + lightDensity);
            emit(makeLeaf(k, BY_SCATTER), throughput * emitted * weight);
        }
        if (hit.triangle == NO_HIT) return;
    }
}

#endif
