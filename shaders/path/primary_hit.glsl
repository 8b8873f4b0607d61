// What a pixel sees in this frame, from the stored hit of primary.comp.
#ifndef SHADERS_PATH_PRIMARY_HIT_GLSL
#define SHADERS_PATH_PRIMARY_HIT_GLSL

#include "path/surfaces.glsl"
#include "scene/camera.glsl"
#include "scene/lights.glsl"

struct PrimaryHit {
    bool seen;     // else the ray met the environment
    Surface s;     // x_1, if seen
    vec3 wo;       // to the camera
    vec3 emission; // radiance that the pixel sees directly
};

PrimaryHit loadPrimaryHit(uvec2 pixel)
{
    uvec4 words = seenBy(pixel.y * frame.width + pixel.x, false);
    PrimaryHit hit;
    hit.seen = words.x != NO_HIT;
    if (hit.seen) {
        vec2 barycentric = uintBitsToFloat(words.yz);
        hit.wo = towardsCamera(frame.camera, hitPosition(words.x, barycentric));
        hit.s = loadSurface(words.x, barycentric, hit.wo);
        hit.emission = hit.s.emission;
    } else {
        uint alphaSeed;
        hit.emission = loadEnvironment(pixelRay(pixel, alphaSeed).direction).rgb;
    }
    return hit;
}

#endif
