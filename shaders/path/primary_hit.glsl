// What each pixel sees, as primary.comp left it, in this frame and in the one before. Binding 0 of every stage that asks.
#ifndef SHADERS_PATH_PRIMARY_HIT_GLSL
#define SHADERS_PATH_PRIMARY_HIT_GLSL

#include "scene/camera.glsl"
#include "scene/lights.glsl"

TABLE(SET_PASS, 0, Surfaces);

Hit seenBy(uint pixel, bool previous)
{
    uint slice = previous ? frame.previousSlice : frame.slice;
    uvec4 words = FETCH(Surfaces, slice * frame.width * frame.height + pixel);
    return Hit(words.x, uintBitsToFloat(words.yz), 0.0);
}

struct PrimaryHit {
    bool seen;     // else the ray met the environment
    Surface s;     // x_1, if seen
    vec3 wo;       // to the camera
    vec3 emission; // radiance that the pixel sees directly
};

PrimaryHit loadPrimaryHit(uvec2 at)
{
    Hit stored = seenBy(at.y * frame.width + at.x, false);
    PrimaryHit hit;
    hit.seen = stored.triangle != NO_HIT;
    if (hit.seen) {
        hit.wo = towardsCamera(frame.camera, hitPosition(stored.triangle, stored.barycentric));
        hit.s = loadSurface(stored.triangle, stored.barycentric, hit.wo);
        hit.emission = hit.s.emission;
    } else {
        uint alphaSeed;
        hit.emission = loadEnvironment(pixelRay(at, alphaSeed).direction).rgb;
    }
    return hit;
}

#endif
