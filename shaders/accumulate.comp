#version 460
#extension GL_GOOGLE_include_directive : require
// The film: per channel the sum of all frames and what rounding took from it (Kahan), exact to fp32 after 10^6 frames.
#include "scene/bindings.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_PASS, binding = 0, std430) readonly buffer Color { vec4 color[]; };
layout(set = SET_PASS, binding = 1, std430) buffer Film { vec4 film[]; }; // two a pixel: sum, carry

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width || pixel.y >= frame.height) return;
    uint index = pixel.y * frame.width + pixel.x;

    precise vec3 sum = film[2u * index].xyz;
    precise vec3 value = color[index].xyz - film[2u * index + 1u].xyz;
    precise vec3 next = sum + value;
    precise vec3 carry = (next - sum) - value;
    film[2u * index] = vec4(finiteOrCounted(next, STAGE_ACCUMULATE), 0.0);
    film[2u * index + 1u] = vec4(carry, 0.0);
}
