#version 460
#extension GL_GOOGLE_include_directive : require
// For measurements: which pixel of the previous frame saw what each pixel of the first run sees now, as temporal.comp asks.
#include "lib/frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_PASS, binding = 1, std430) writeonly buffer PreviousPixels { uint previousPixels[]; };

#include "domain.glsl"

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= frame.width || at.y >= frame.runHeight) return;
    uint pixel = at.y * frame.width + at.x;

    Domain here = makeDomain(pixel, false);
    uint previousPixel;
    bool found = here.seen && reproject(here, pixel, previousPixel) && alike(here, carriedOn(makeDomain(previousPixel, true)));
    previousPixels[pixel] = found ? previousPixel : NO_NEIGHBOR;
}
