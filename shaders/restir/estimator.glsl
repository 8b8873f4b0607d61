// Channels meet reservoirs here, through the frame's two tables, and nowhere else.
#ifndef SHADERS_RESTIR_ESTIMATOR_GLSL
#define SHADERS_RESTIR_ESTIMATOR_GLSL

#include "lib/frame.glsl"
#include "restir/reservoir.glsl"

// p_hat_c
float targetOf(uint c, vec3 f) { return dot(frame.target[c].xyz, f); }

// chi_c: the color that a sample gives to the pixel per unit of its weight in reservoir c; 0 where there is no sample.
vec3 colorOf(uint c, vec3 f)
{
    float target = targetOf(c, f);
    return target > 0.0 ? frame.resolve[c].xyz * (f / target) : vec3(0.0);
}

// Color of reservoir c: resolve[c] f(Y) W with W = S / p_hat_c(f(Y)); for RGB this is S, which Algorithm 3 returns.
vec3 resolved(uint c, Reservoir r) { return colorOf(c, r.f) * (r.weightSum + r.carry); }

// COLOR_VARIATE: beside its reservoirs a pixel keeps A, an estimate of its color that is unbiased by itself. A merge makes of
// those of several domains the mean of what each says of the pixel's own, the samples being control variates only:
//     A' = sum over merged j of beta_j (k_j A_j + D_j),   D_j an estimate of color here - k_j color there
// Any beta (of sum 1) and k do that depend on no sample: beta_j is a share of the confidences, k_j the ratio of albedos, here
// over there. Between equal domains D is 0, and A' the mean of all A_j. (After ReSTCV, SIGGRAPH 2026; what was compared is in
// docs/DECISIONS.md, "Color beside the reservoirs".)

// D, of what reservoir c of this pixel (with its sample moved there) and that of another (moved here) know, each with its MIS
// weight. `confidence` is what they count for, here and there.
vec3 colorDifference(uint c, Reservoir here, vec3 fThere, Reservoir there, vec3 fHere, vec2 confidence, vec3 k)
{
    float rho = ratio(targetOf(c, fThere), targetOf(c, here.f));
    float rhoThere = ratio(targetOf(c, fHere), targetOf(c, there.f));
    precise vec3 byOwn = rest(confidence.y, rho, confidence.x) * colorOf(c, here.f) -
                         k * (restTimes(confidence.y, rho, confidence.x) * colorOf(c, fThere));
    precise vec3 byOther = restTimes(confidence.x, rhoThere, confidence.y) * colorOf(c, fHere) -
                           k * (rest(confidence.x, rhoThere, confidence.y) * colorOf(c, there.f));
    return here.weightSum * byOwn + there.weightSum * byOther;
}

// The albedo of what a pixel sees, as a word beside A: squares of 10 bits, since it is dark ones that need steps. (Beyond
// [0, 1] there is none. The ratio is a coefficient that knows no sample, so what it loses here biases nothing.)
uint packedAlbedo(vec3 albedo)
{
    uvec3 steps = uvec3(1023.0 * sqrt(clamp(albedo, 0.0, 1.0)) + 0.5);
    return steps.x | steps.y << 10u | steps.z << 20u;
}

// k: what A of a pixel that sees albedo `there` is worth `here`, per channel; 1 where one of them is black, and at most 2.
vec3 albedoRatio(uint here, uint there)
{
    vec3 a = vec3(uvec3(here, here >> 10u, here >> 20u) & 1023u);
    vec3 b = vec3(uvec3(there, there >> 10u, there >> 20u) & 1023u);
    vec3 root = a / max(b, 1.0);
    return mix(min(root * root, 2.0), vec3(1.0), equal(a * b, vec3(0.0)));
}

// a + change, rounded up or down at random so that the mean is exact: in a history of 2^20 frames all changes of a dark frame
// would be rounded alike.
float roundedAtRandom(float a, float change, float u)
{
    float lost;
    float sum = sumOf(a, change, lost);
    uint bits = floatBitsToUint(sum);
    float next = uintBitsToFloat((lost > 0.0) == (sum > 0.0) ? bits + 1u : bits - 1u);
    return u * abs(next - sum) < abs(lost) ? next : sum;
}
vec3 roundedAtRandom(vec3 a, vec3 change, uvec3 random)
{
    return vec3(roundedAtRandom(a.x, change.x, decisionFloat(random.x)), roundedAtRandom(a.y, change.y, decisionFloat(random.y)),
                roundedAtRandom(a.z, change.z, decisionFloat(random.z)));
}

#endif
