#version 460
#extension GL_GOOGLE_include_directive : require
// The film: per channel the sum of all frames and what rounding took from it (Kahan), exact to fp32 after 10^6 frames.
#include "lib/frame.glsl"
#include "shared/rows.h"
layout(local_size_x = 8, local_size_y = 8) in;
TABLE(SET_PASS, 0, Color);
TABLE_INOUT(SET_PASS, 1, Film);

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= frame.width || at.y >= frame.height) return;
    uint pixel = at.y * frame.width + at.x;

    precise vec3 sum = colorIn(Film, FILM_ROWS * pixel);
    precise vec3 value = colorIn(Color, pixel) - colorIn(Film, FILM_ROWS * pixel + 1u);
    precise vec3 next = sum + value;
    precise vec3 carry = (next - sum) - value;
    STORE(Film, FILM_ROWS * pixel, rowOf(finiteOrCounted(next, STAGE_ACCUMULATE)));
    STORE(Film, FILM_ROWS * pixel + 1u, rowOf(carry));
}
