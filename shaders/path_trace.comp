#version 460
#extension GL_GOOGLE_include_directive : require
// The plain path tracer: sums every path that the walker reports.
#include "lib/frame.glsl"
#include "lib/table.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
TABLE_OUT(SET_PASS, 1, Color);

#include "path/primary_hit.glsl"
#include "path/walk.glsl"

vec3 radiance = vec3(0.0);
bool visit(Vertex x) { return true; }
bool wants(uint leaf) { return true; }
bool goesOn(uint k) { return k < MAX_BOUNCES || HAS_REACHABLE_LIGHT; }
void emit(uint leaf, vec3 f, Ending e) { radiance += finiteOrCounted(f, STAGE_PATH_TRACE); }

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width || pixel.y >= frame.height) return;
    uint index = pixel.y * frame.width + pixel.x;

    PrimaryHit hit = loadPrimaryHit(pixel);
    radiance = finiteOrCounted(hit.emission, STAGE_PATH_TRACE);
    if (hit.seen) walk(hit.s, hit.wo, PathSeed(frame.frame, index));
    STORE(Color, index, rowOf(radiance));
    addToCounter(COUNTER_BOUNCE, tracedRays);
    addToCounter(COUNTER_SHADOW, shadowRays);
}
