// Sampling routines: unit squares to directions and points.
#ifndef SHADERS_LIB_SAMPLING_GLSL
#define SHADERS_LIB_SAMPLING_GLSL

const float PI = 3.14159265358979;

// The point of the unit circle at an angle given in turns, to 2e-7. Vulkan promises no more than 2^-11 of sin and cos, and that
// within [-pi, pi] only. What is left of a quarter turn is exact; polynomials: Moshier, Cephes, sinf and cosf.
vec2 unitCircle(float turns)
{
    float quarters = round(4.0 * turns);
    float a = 2.0 * PI * (turns - 0.25 * quarters);
    float a2 = a * a;
    float s = a + a * a2 * (-1.6666654611e-1 + a2 * (8.3321608736e-3 - a2 * 1.9515295891e-4));
    float c = 1.0 - 0.5 * a2 + a2 * a2 * (4.1666645683e-2 + a2 * (-1.3887316255e-3 + a2 * 2.4433157118e-5));
    int quadrant = int(quarters) & 3;
    vec2 p = (quadrant & 1) == 0 ? vec2(c, s) : vec2(-s, c);
    return quadrant < 2 ? p : -p;
}

// The angle of p, of any length, in turns from 0 to 1: the inverse of unitCircle, to 1e-7. Polynomial: Abramowitz and Stegun
// 1964, 4.4.49.
float turnsOf(vec2 p)
{
    vec2 a = abs(p);
    float t = min(a.x, a.y) / max(max(a.x, a.y), 1.17549435e-38);
    float t2 = t * t;
    float series = -0.0161657367 + t2 * 0.0028662257;
    series = -0.0752896400 + t2 * (0.0429096138 + t2 * series);
    series = -0.1420889944 + t2 * (0.1065626393 + t2 * series);
    series = -0.3333314528 + t2 * (0.1999355085 + t2 * series);
    float turns = (t + t * t2 * series) * (0.5 / PI);
    if (a.y > a.x) turns = 0.25 - turns;
    if (p.x < 0.0) turns = 0.5 - turns;
    return p.y < 0.0 ? 1.0 - turns : turns;
}

// Cosine-weighted hemisphere about +z; pdf = z / pi.
vec3 sampleCosineHemisphere(vec2 u) { return vec3(sqrt(u.x) * unitCircle(u.y), sqrt(1.0 - u.x)); }

// Uniform point of a triangle, as barycentric weights of vertices 1 and 2. Heitz, "A Low-Distortion Map Between Triangle and
// Square", 2019.
vec2 sampleTriangle(vec2 u)
{
    return u.y > u.x ? vec2(0.5 * u.x, u.y - 0.5 * u.x) : vec2(u.x - 0.5 * u.y, 0.5 * u.y);
}

#endif
