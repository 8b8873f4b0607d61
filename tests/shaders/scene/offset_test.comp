#version 460
#extension GL_GOOGLE_include_directive : require
// Rays that leave surface points: from the point of a triangle at given barycentrics, computed as surface.glsl does.
#include "lib/lanes.glsl"
#include "shared/types.h"
layout(local_size_x = 64) in;

const bool HAS_ALPHA = false;
const bool HAS_INSTANCES = false;
const uint STACK_SIZE = 32u;
const bool STACK_IN_REGISTERS = false;

TABLE(SET_SCENE, 0, Nodes);
TABLE(SET_SCENE, 1, Triangles);
struct Leaving {
    vec4 v0; // of the triangle; w: barycentric u
    vec4 v1; // w: barycentric v
    vec4 v2;
    vec4 direction;
};
layout(set = SET_PASS, binding = 0, std430) readonly buffer Rays { Leaving rays[]; };
layout(set = SET_PASS, binding = 1, std430) writeonly buffer Hits { uvec4 hits[]; }; // triangle | occluded << 31, u, v, t

bool alphaPasses(uint triangle, vec2 barycentric, uint alphaSeed) { return true; }

#include "scene/intersect.glsl"

void main()
{
    uint index = gl_GlobalInvocationID.x;
    if (index >= uint(hits.length())) return;
    Leaving from = rays[index];
    float u = from.v0.w, v = from.v1.w;
    precise vec3 position = (1.0 - u - v) * from.v0.xyz + u * from.v1.xyz + v * from.v2.xyz;
    vec3 normal = normalize(cross(from.v1.xyz - from.v0.xyz, from.v2.xyz - from.v0.xyz));
    vec3 direction = from.direction.xyz;
    vec3 size = max(abs(from.v0.xyz), max(abs(from.v1.xyz), abs(from.v2.xyz)));
    Ray ray = Ray(offsetOrigin(position, normal, direction, originOffset(normal, size)), direction, RAY_MAX);
    Hit hit = closestHit(ray, 0u);
    uint blocked = occluded(ray, 0u) ? 0x80000000u : 0u;
    hits[index] = uvec4((hit.triangle & 0x7fffffffu) | blocked, floatBitsToUint(vec3(hit.barycentric, hit.t)));
}
