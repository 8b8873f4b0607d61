// Sampling routines: unit squares to directions and points.
#ifndef SHADERS_LIB_SAMPLING_GLSL
#define SHADERS_LIB_SAMPLING_GLSL

const float PI = 3.14159265358979;

// Cosine-weighted hemisphere about +z; pdf = z / pi.
vec3 sampleCosineHemisphere(vec2 u)
{
    float r = sqrt(u.x);
    float phi = 2.0 * PI * u.y;
    return vec3(r * cos(phi), r * sin(phi), sqrt(1.0 - u.x));
}

// Uniform point of a triangle, as barycentric weights of vertices 1 and 2. Heitz, "A Low-Distortion Map Between Triangle and
// Square", 2019.
vec2 sampleTriangle(vec2 u)
{
    return u.y > u.x ? vec2(0.5 * u.x, u.y - 0.5 * u.x) : vec2(u.x - 0.5 * u.y, 0.5 * u.y);
}

#endif
