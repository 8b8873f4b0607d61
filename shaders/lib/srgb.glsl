// sRGB to linear: IEC 61966-2-1.
#ifndef SHADERS_LIB_SRGB_GLSL
#define SHADERS_LIB_SRGB_GLSL

// x^2.4 is a polynomial of y = sqrt(x), fitted to 8-bit c above the linear part: off by 1e-7 of the value there, in fp32 by less
// than 1e-6. Each texel of each look-up is decoded, sRGB or not, and powers cost 5 to 7% of a textured frame.
vec3 linearFromSrgb(vec3 c)
{
    vec3 low = c / 12.92;
    vec3 y = sqrt((c + 0.055) / 1.055);
    vec3 high = ((((((0.012068917 * y - 0.08960291) * y + 0.90987986) * y + 0.20850612) * y - 0.049689252) * y + 0.010022997) * y -
                 0.001256465) * y + 7.084519e-5;
    return mix(high, low, lessThanEqual(c, vec3(0.04045)));
}

#endif
