#version 460
#extension GL_GOOGLE_include_directive : require
// The plain path tracer: sums every path that the walker reports.
#include "scene/bindings.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_PASS, binding = 0, std430) readonly buffer Surfaces { uvec4 surfaces[]; };
layout(set = SET_PASS, binding = 1, std430) writeonly buffer Color { vec4 color[]; };

vec3 radiance = vec3(0.0);
void emit(uint leaf, vec3 f) { radiance += finiteOrCounted(f, STAGE_PATH_TRACE); }
#include "path/walk.glsl"

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width || pixel.y >= frame.height) return;
    uint index = pixel.y * frame.width + pixel.x;

    uvec4 hit = surfaces[index];
    PathSeed seed = PathSeed(frame.frame, index);
    if (hit.x == NO_HIT) {
        uint alphaSeed;
        radiance = loadEnvironment(pixelRay(pixel, alphaSeed).direction).rgb;
    } else {
        vec2 barycentric = uintBitsToFloat(hit.yz);
        vec3 wo = towardsCamera(frame.camera, hitPosition(hit.x, barycentric));
        Surface s = loadSurface(hit.x, barycentric, wo);
        radiance = finiteOrCounted(s.emission, STAGE_PATH_TRACE);
        walk(s, wo, seed, MAX_BOUNCES);
    }
    color[index] = vec4(radiance, 0.0);
    addToCounter(COUNTER_BOUNCE, bounceRays);
    addToCounter(COUNTER_SHADOW, shadowRays);
}
