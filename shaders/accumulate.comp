#version 460
#extension GL_GOOGLE_include_directive : require
// The film: per channel the sum of all frames and what rounding took from it (Kahan), exact to fp32 after 10^6 frames.
#include "lib/table.glsl"
#include "scene/bindings.glsl"
#include "shared/rows.h"
layout(local_size_x = 8, local_size_y = 8) in;
TABLE(SET_PASS, 0, Color);
TABLE_INOUT(SET_PASS, 1, Film);

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width || pixel.y >= frame.height) return;
    uint index = pixel.y * frame.width + pixel.x;

    precise vec3 sum = colorIn(Film, FILM_ROWS * index);
    precise vec3 value = colorIn(Color, index) - colorIn(Film, FILM_ROWS * index + 1u);
    precise vec3 next = sum + value;
    precise vec3 carry = (next - sum) - value;
    STORE(Film, FILM_ROWS * index, rowOf(finiteOrCounted(next, STAGE_ACCUMULATE)));
    STORE(Film, FILM_ROWS * index + 1u, rowOf(carry));
}
