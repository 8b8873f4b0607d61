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

#endif
