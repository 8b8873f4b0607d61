#version 460
#extension GL_GOOGLE_include_directive : require
// Paths within a closed body whose faces look inward, aimed at its edges and corners: does every ray meet a face from inside?
#include "scene/bindings.glsl"
layout(local_size_x = 64) in;

struct Path {
    vec4 origin;    // scaled
    vec4 direction; // w: that of x_2 and on is drawn from the seed, as bits
};
layout(set = SET_PASS, binding = 0, std430) readonly buffer Paths { Path paths[]; };
layout(set = SET_PASS, binding = 1, std430) buffer Leaks { uint leaks[]; }; // how many; then of the first ones: path, bounce, triangle, next

#include "lib/sampling.glsl"
#include "scene/camera.glsl"

const uint BOUNCES = 4u;

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(paths.length())) return;
    vec3 origin = paths[i].origin.xyz;
    vec3 direction = paths[i].direction.xyz;
    uint seed = floatBitsToUint(paths[i].direction.w);
    uint from = NO_HIT;
    for (uint bounce = 0u; bounce <= BOUNCES; ++bounce) {
        Hit hit = nearestHit(Ray(origin, direction, RAY_MAX), 0u);
        bool inside = hit.triangle != NO_HIT && dot(loadTriangle(hit.triangle).areaNormal, direction) < 0.0;
        bool blocked = occluded(Ray(origin, direction, RAY_MAX), 0u);
        if (!inside || !blocked) {
            uint slot = atomicAdd(leaks[0], 1u);
            if (slot < 8u) {
                leaks[4u * slot + 4u] = i;
                leaks[4u * slot + 5u] = bounce;
                leaks[4u * slot + 6u] = from;
                leaks[4u * slot + 7u] = hit.triangle;
            }
            return;
        }
        Surface s = loadSurface(hit.triangle, hit.barycentric, -direction);
        uvec4 random = pcg4d(uvec4(seed, i, bounce, 17u));
        direction = normalize(basisFromNormal(s.geometricNormal) *
                              sampleCosineHemisphere(vec2(unitFloat(random.x), unitFloat(random.y))));
        origin = departure(s, direction);
        from = hit.triangle;
    }
}
