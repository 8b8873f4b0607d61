// Channels meet reservoirs here, through the frame's two tables, and nowhere else.
#ifndef SHADERS_RESTIR_ESTIMATOR_GLSL
#define SHADERS_RESTIR_ESTIMATOR_GLSL

#include "lib/frame.glsl"
#include "restir/reservoir.glsl"

// p_hat_c
float targetOf(uint c, vec3 f) { return dot(frame.target[c].xyz, f); }

// Color of reservoir c: resolve[c] f(Y) W with W = S / p_hat_c(f(Y)).
vec3 resolved(uint c, Reservoir r)
{
    float target = targetOf(c, r.f);
    return target > 0.0 ? frame.resolve[c].xyz * (r.f / target) * (r.weightSum + r.carry) : vec3(0.0);
}

#endif
