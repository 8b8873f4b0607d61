// What each pixel sees, as primary.comp left it: triangle and barycentrics, of this frame and of the one before. Binding 0
// of every stage that asks.
#ifndef SHADERS_PATH_SURFACES_GLSL
#define SHADERS_PATH_SURFACES_GLSL

#include "lib/frame.glsl"

layout(set = SET_PASS, binding = 0, std430) readonly buffer Surfaces { uvec4 surfaces[]; };

uvec4 seenBy(uint pixel, bool previous)
{
    uint slice = previous ? 1u - frame.slice : frame.slice;
    return surfaces[slice * frame.width * frame.height + pixel];
}

#endif
