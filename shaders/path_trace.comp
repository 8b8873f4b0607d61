#version 460
#extension GL_GOOGLE_include_directive : require
// The plain path tracer: sums every path that the walker reports.
#include "lib/frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
TABLE_OUT(SET_PASS, 1, Color);

#include "path/primary_hit.glsl"
#include "path/walk.glsl"

vec3 radiance = vec3(0.0);
bool visit(Vertex x) { return true; }
bool wants(uint pathId) { return true; }
bool goesOn(uint k) { return k < MAX_BOUNCES || HAS_REACHABLE_LIGHT; }
void emit(uint pathId, vec3 f, Ending e) { radiance += finiteOrCounted(f, STAGE_PATH_TRACE); }

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= frame.width || at.y >= frame.height) return;
    uint pixel = at.y * frame.width + at.x;

    PrimaryHit hit = loadPrimaryHit(at);
    radiance = finiteOrCounted(hit.emission, STAGE_PATH_TRACE);
    if (hit.seen) walk(hit.s, hit.wo, PathSeed(frame.frame, pixel));
    STORE(Color, pixel, rowOf(radiance));
    addToCounter(COUNTER_BOUNCE, tracedRays);
    addToCounter(COUNTER_SHADOW, shadowRays);
}
