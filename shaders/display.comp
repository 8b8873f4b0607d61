#version 460
#extension GL_GOOGLE_include_directive : require
// What the screen shows of a picture: exposure, tone curve, sRGB. Run by the window on the device that draws; no stage of a
// frame.
#include "lib/lanes.glsl"
#include "shared/display.h"
layout(local_size_x = 8, local_size_y = 8) in;
// Width, height, exposure, curve; then a row each pixel: linear RGB and 0, or a color that is sRGB already and 1.
TABLE(0, 0, Picture);
layout(set = 0, binding = 1, std430) writeonly buffer Screen { uint screen[]; }; // RGBA, 8 bit each

const vec3 ALARM = vec3(1.0, 0.0, 1.0); // not a number

float onCurve(float c, uint curve)
{
    if (curve == CURVE_REINHARD) return 1.0 - 1.0 / (1.0 + c);
    if (curve == CURVE_NONE) return c;
    float low = min(c, 8.0); // white from 7.3 on, and no quotient of infinities
    return low * (2.51 * low + 0.03) / (low * (2.43 * low + 0.59) + 0.14); // Narkowicz 2015
}

// IEC 61966-2-1.
float srgb(float linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(min(linear, 1.0), 1.0 / 2.4) - 0.055;
}

// By their bits: compilers that are told of no such values take isnan away.
bool anyNan(uvec3 bits)
{
    return any(greaterThan(bits & 0x7fffffffu, uvec3(0x7f800000u)));
}

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    uvec4 header = FETCH(Picture, 0u);
    if (at.x >= header.x || at.y >= header.y) return;
    uint index = at.y * header.x + at.x;

    uvec4 pixel = FETCH(Picture, 1u + index);
    vec3 color = uintBitsToFloat(pixel.xyz);
    if (anyNan(pixel.xyz))
        color = ALARM;
    else if (pixel.w == 0u)
        for (int c = 0; c < 3; ++c) color[c] = srgb(onCurve(max(color[c] * uintBitsToFloat(header.z), 0.0), header.w));
    screen[index] = packUnorm4x8(vec4(color, 1.0));
}
