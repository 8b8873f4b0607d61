// What each pixel sees, as primary.comp left it: triangle and barycentrics, of this frame and of the one before. Binding 0
// of every stage that asks.
#ifndef SHADERS_PATH_SURFACES_GLSL
#define SHADERS_PATH_SURFACES_GLSL

#include "lib/frame.glsl"
#include "lib/table.glsl"

TABLE(SET_PASS, 0, Surfaces);

uvec4 seenBy(uint pixel, bool previous)
{
    uint slice = previous ? frame.previousSlice : frame.slice;
    return FETCH(Surfaces, slice * frame.width * frame.height + pixel);
}

#endif
