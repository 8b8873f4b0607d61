// The one path walker. It traces the path tree of one seed from a primary hit. Sampling, replay and plain path tracing
// differ only in four functions of the including stage (path/hooks.glsl): visit, wants, goesOn, emit.
#ifndef SHADERS_PATH_WALK_GLSL
#define SHADERS_PATH_WALK_GLSL

#include "path/reconnection.glsl"
#include "scene/lights.glsl"

// Can a scattered ray find light at all? If not, the last one is not traced.
const bool HAS_REACHABLE_LIGHT = HAS_EMISSIVE || HAS_ENVIRONMENT || HAS_UNLIT;

// A walk may begin behind x_1, where a path goes on that is known so far. If it is known to leave in a direction, that is it.
uint firstVertex = 1u;
vec3 firstDirection = vec3(0.0);

uint tracedRays = 0u;
uint shadowRays = 0u;

uvec4 pathRandom(PathSeed seed, uint k, uint purpose)
{
    return randomBlock(seed, STREAM_PATH + 2u * k + purpose, uvec2(frame.key0, frame.key1));
}

// From surface s to a target, or in that direction to infinity. Both ends are moved off their surfaces (the target has none
// where its normal is 0), and the ray ends short of the target, since rounding may find a surface there a little nearer.
ShadowRay shadowRay(Surface s, bool infinite, vec3 target, vec3 targetNormal, float targetOffset, vec3 direction, uint alphaSeed)
{
    vec3 origin = departure(s, direction);
    vec3 d = offsetOrigin(target, targetNormal, -direction, targetOffset) - origin;
    float distance = length(d);
    Ray finite = Ray(origin, d / distance, distance * (1.0 - 4.0 * POSITION_ERROR));
    return ShadowRay(infinite ? Ray(origin, direction, RAY_MAX) : finite, alphaSeed);
}

bool isBlocked(ShadowRay shadow) { return shadow.ray.tMax > 0.0 && occluded(shadow.ray, shadow.alphaSeed); }

#ifndef DEFERS_SHADOW_RAYS
void emitUnlessBlocked(uint pathId, vec3 f, Ending e, ShadowRay shadow)
{
    if (!isBlocked(shadow)) emit(pathId, f, e);
}
#endif

// Next-event estimation at x_k. f L / (p_N + p_B) is the balance heuristic's weight (Veach and Guibas 1995) times f L / p_N,
// without 0/0.
void emitByLight(Vertex x, PathSeed seed)
{
    uvec4 random = pathRandom(seed, x.k, PURPOSE_LIGHT);
    LightSample light = sampleLight(random, x.s);
    float scatterPdf;
    vec3 carried = evaluate(x.bsdf, light.direction * x.bsdf.frame, light.direction, scatterPdf) * light.radiance;
    if (x.throughput * carried == vec3(0.0)) return; // both densities may be 0 then
    float density = light.dirac ? light.pdf : light.pdf + scatterPdf;
    Ending e = Ending(light.direction, light.radiance, carried / density, light.pdf);
    if (light.dirac) {
        e.radiance /= light.pdf;
        e.lightPdf = -1.0;
    }
    ++shadowRays;
    emitUnlessBlocked(makePathId(x.k, BY_LIGHT), x.throughput * e.weighted, e,
                      shadowRay(x.s, light.infinite, light.target, light.normal, light.offset, light.direction, random.w));
}

Scatter scatterAt(Vertex x, uvec4 random)
{
    if (BETWEEN_WORLDS && x.k == firstVertex && firstDirection != vec3(0.0)) return Scatter(firstDirection, vec3(1.0), 1.0, false);
    return sampleBsdf(x.bsdf, vec3(unitFloat(random.x), unitFloat(random.y), unitFloat(random.z)));
}

// Surface s is the first vertex, x_1 of a whole path, seen from direction wo.
void walk(Surface s, Bsdf bsdf, vec3 wo, PathSeed seed)
{
    if (MAX_BOUNCES == 0u) return;
    reconnectionVertex = NO_VERTEX;
    Vertex x;
    x.s = s;
    x.bsdf = bsdf;
    x.throughput = vec3(1.0);
    x.k = firstVertex;
    LOOP_BEGIN(x.k <= MAX_BOUNCES)
        if (absorbs(x.bsdf) || !visit(x)) return;
        if (wants(makePathId(x.k, BY_LIGHT))) emitByLight(x, seed);
        if (!goesOn(x.k)) return;

        uvec4 random = pathRandom(seed, x.k, PURPOSE_SCATTER);
        Segment to;
        to.scatter = scatterAt(x, random);
        x.throughput *= to.scatter.weight;
        if (x.throughput == vec3(0.0)) return;
        ++tracedRays;
        wo = -to.scatter.direction;
        vec3 origin = departure(x.s, to.scatter.direction);
        to.hit = nearestHit(Ray(origin, to.scatter.direction, RAY_MAX), random.w);
        noteDeparture(x, to.scatter);

        // Light found by scattering, weighted against next-event estimation.
        Ending e = Ending(to.scatter.direction, vec3(0.0), vec3(0.0), 0.0);
        Surface next;
        if (to.hit.triangle == NO_HIT) {
            if (!HAS_ENVIRONMENT) return;
            vec4 environment = loadEnvironment(to.scatter.direction);
            e.radiance = environment.rgb;
            e.lightPdf = environmentPdf(environment);
            to.distance = RAY_MAX;
            to.arrival = to.scatter.pdf;
        } else {
            next = loadSurface(to.hit.triangle, to.hit.barycentric, wo);
            vec3 d = next.position - origin;
            to.distance = length(d);
            to.arrival = to.scatter.pdf * abs(dot(next.geometricNormal, wo)) / dot(d, d);
            e.radiance = next.emission;
            e.lightPdf = lightPdf(next, origin, to.scatter.direction);
        }
        if (e.radiance != vec3(0.0)) {
            e.weighted = e.radiance * (to.scatter.dirac ? 1.0 : to.scatter.pdf / (to.scatter.pdf + e.lightPdf));
            noteLight(x, to, next);
            emit(makePathId(x.k, BY_SCATTER), x.throughput * e.weighted, e);
        }
        if (to.hit.triangle == NO_HIT) return;
        noteArrival(x, to, next);
        x.s = next;
        x.bsdf = makeBsdf(next, wo);
        ++x.k;
    LOOP_END(x.k <= MAX_BOUNCES)
}

void walk(Surface s, vec3 wo, PathSeed seed) { walk(s, makeBsdf(s, wo), wo, seed); }

#endif
