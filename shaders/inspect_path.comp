#version 460
#extension GL_GOOGLE_include_directive : require
// The paths that one pixel's reservoirs hold, walked again and written down vertex by vertex, for the window; no stage of a
// frame. What precedes the reconnection vertex x_r is replayed in the pixel's own domain. What follows it is replayed
// from x_r: it knows nothing of the pixel that drew it.
#include "lib/frame.glsl"
#include "shared/inspection.h"
layout(local_size_x = 8) in;
TABLE(SET_PASS, 1, History);
TABLE(SET_PASS, 2, HistoryPaths);
layout(set = SET_PASS, binding = 3, std430) readonly buffer Request { PathRequest request; };
layout(set = SET_PASS, binding = 4, std430) writeonly buffer PathPoints { PathPoint pathPoints[]; };

#include "path/primary_hit.glsl"
#include "path/walk.glsl"
#include "restir/reservoir_store.glsl"
LOAD_RESERVOIRS(History, History, HistoryPaths)

const uint POINTS = MAX_BOUNCES + 1u; // x_1 .. and the light
const float FAR = 4.0;                // scaled: beyond every scene

PathSample path;
uint count = 0u; // points so far
Surface last;    // x of the last one that scatters

void addPoint(vec3 position, uint kind)
{
    if (count == POINTS) return;
    vec3 seen = project(frame.camera, position);
    pathPoints[gl_GlobalInvocationID.x * POINTS + count++] = PathPoint(seen.x, seen.y, seen.z, kind);
}

void addEnd(bool infinite, vec3 position, vec3 direction)
{
    addPoint(infinite ? last.position + FAR * direction : position, infinite ? POINT_FAR : POINT_LIGHT);
}

void addHit(Hit hit, vec3 direction)
{
    bool infinite = hit.triangle == NO_HIT;
    addEnd(infinite, hitPosition(infinite ? 0u : hit.triangle, hit.barycentric), direction);
}

// As next-event estimation at the last point drew it.
void addSampledLight()
{
    LightSample light = sampleLight(pathRandom(path.seed, scatteringsOf(path.pathId), PURPOSE_LIGHT), last);
    addEnd(light.infinite, light.target, light.direction);
}

bool visit(Vertex x)
{
    last = x.s;
    addPoint(x.s.position, POINT_SURFACE);
    return x.k + 1u != path.reconnectionIndex;
}
bool wants(uint pathId) { return pathId == path.pathId; }
bool goesOn(uint k) { return path.pathId > makePathId(k, BY_LIGHT); }
void emit(uint pathId, vec3 f, Ending e)
{
    if (pathId != path.pathId) return;
    if (techniqueOf(pathId) == BY_LIGHT) addSampledLight();
    else addHit(Hit(lightVertex.kept.triangle, lightVertex.kept.barycentric, 0.0), e.direction);
}

// From the last point to x_r and what it scatters to. True when the walk goes on from there, at s.
bool join(out Surface s, out vec3 wo)
{
    Reconnection r = path.reconnection;
    uint k = path.reconnectionIndex;
    if (r.triangle == NO_HIT || k > scatteringsOf(path.pathId)) { // x_r is the light
        addHit(Hit(r.triangle, r.barycentric, 0.0), r.direction);
        return false;
    }
    vec3 position = hitPosition(r.triangle, r.barycentric);
    last = loadSurface(r.triangle, r.barycentric, normalize(last.position - position));
    addPoint(position, POINT_SURFACE);
    if (path.pathId == makePathId(k, BY_LIGHT)) {
        addSampledLight();
        return false;
    }
    Hit hit = nearestHit(Ray(departure(last, r.direction), r.direction, RAY_MAX), pathRandom(path.seed, k, PURPOSE_SCATTER).w);
    if (path.pathId == makePathId(k, BY_SCATTER)) addHit(hit, r.direction);
    if (path.pathId == makePathId(k, BY_SCATTER) || hit.triangle == NO_HIT) return false;
    wo = -r.direction;
    s = loadSurface(hit.triangle, hit.barycentric, wo);
    return true;
}

void main()
{
    uint c = gl_GlobalInvocationID.x;
    if (c >= RESERVOIR_COUNT || request.pixel >= frame.width * frame.height) return;
    for (uint i = 0u; i < POINTS; ++i) pathPoints[c * POINTS + i].kind = POINT_NONE;

    PrimaryHit hit = loadPrimaryHit(uvec2(request.pixel % frame.width, request.pixel / frame.width));
    if (!hit.seen) return;
    path = NO_SAMPLE;
    path.seed = PathSeed(frame.frame, request.pixel);
    path.pathId = makePathId(MAX_BOUNCES + 1u, BY_LIGHT);
    if (request.plain == 0u) {
        Reservoir r = loadHistoryHead(request.pixel, c);
        if (!(r.weightSum > 0.0)) return;
        path = r.chosen;
        path.reconnection = loadHistoryPath(request.pixel, c);
    }
    for (uint part = 0u; part < 2u; ++part) { // a loop, so that the walk is compiled once
        walk(hit.s, hit.wo, path.seed);
        uint r = path.reconnectionIndex;
        if (part == 1u || r == 0u || count + 1u != r || !join(hit.s, hit.wo)) return;
        firstVertex = r + 1u;
    }
}
