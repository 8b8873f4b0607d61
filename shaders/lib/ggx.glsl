// The GGX (Trowbridge-Reitz) microfacet distribution and Fresnel terms, in a local frame where the normal is +z.
// a is alpha_g = roughness^2. Forms without cancellation or division by a cosine: exact down to grazing and a = 1/4096.
#ifndef SHADERS_LIB_GGX_GLSL
#define SHADERS_LIB_GGX_GLSL

#include "lib/lanes.glsl"
#include "lib/sampling.glsl"

// D(h); Walter et al. 2007, Eq. 33.
float ggxDistribution(vec3 h, float a)
{
    vec2 s = h.xy / a;
    float t = dot(s, s) + h.z * h.z;
    return 1.0 / (PI * a * a * t * t);
}

// sqrt(a^2 + (1 - a^2) c^2): c (1 + 2 Lambda(c)).
float ggxSlope(float c, float a) { return sqrt(a * a + (1.0 - a * a) * c * c); }

// G2 / (cos o cos i), height-correlated Smith; Heitz 2014, Eq. 99.
float ggxShadowing(float co, float ci, float a) { return 2.0 / (co * ggxSlope(ci, a) + ci * ggxSlope(co, a)); }

// Density of visible normals D_o(h) divided by (w_o . h): G1(o) D(h) / cos o; Heitz 2018.
float ggxVisible(float co, vec3 h, float a) { return 2.0 * ggxDistribution(h, a) / (co + ggxSlope(co, a)); }

// A visible normal; Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", 2023. wo.z > 0.
vec3 sampleVisibleNormal(vec3 wo, float a, vec2 u)
{
    vec3 stretched = normalize(vec3(a * wo.xy, wo.z));
    float z = fma(1.0 - u.y, 1.0 + stretched.z, -stretched.z);
    float r = sqrt(max(1.0 - z * z, 0.0));
    vec3 h = vec3(r * unitCircle(u.x), z) + stretched;
    return normalize(vec3(a * h.xy, max(h.z, 0.0)));
}

float schlickWeight(float c)
{
    float x = within(1.0 - c, 0.0, 1.0);
    float x2 = x * x;
    return x2 * x2 * x;
}

// Unpolarised reflectance of a dielectric; eta = index beyond / index on this side, c = |cos| on this side.
float fresnelDielectric(float c, float eta)
{
    float g2 = eta * eta - 1.0 + c * c;
    if (g2 <= 0.0) return 1.0; // total internal reflection
    float g = sqrt(g2);
    float a = (g - c) / (g + c);
    float b = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
    return 0.5 * a * a * (1.0 + b * b);
}

#endif
