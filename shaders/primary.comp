#version 460
#extension GL_GOOGLE_include_directive : require
// Camera rays: which surface point each pixel sees. Everything else about it is recomputed from the stored hit.
#include "scene/camera.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
TABLE_OUT(SET_PASS, 0, Surfaces);

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= frame.width || at.y >= frame.height) return;
    uint pixel = at.y * frame.width + at.x;

    uint alphaSeed;
    Ray ray = pixelRay(at, alphaSeed);
    Hit hit = nearestHit(ray, alphaSeed);
    STORE(Surfaces, frame.slice * frame.width * frame.height + pixel, uvec4(hit.triangle, floatBitsToUint(hit.barycentric), 0u));
    addToCounter(COUNTER_PRIMARY, 1u);
}
