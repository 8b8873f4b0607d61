#version 460
#extension GL_GOOGLE_include_directive : require
// Traces the given rays with closestHit and occluded.
#include "lib/lanes.glsl"
#include "shared/types.h"
layout(local_size_x = 64) in;

layout(constant_id = 0) const bool HAS_ALPHA = false;
layout(constant_id = 1) const bool TRACE_OCCLUDED = true;
layout(constant_id = 2) const uint STACK_SIZE = 32u;
layout(constant_id = 3) const bool STACK_IN_REGISTERS = false;
layout(constant_id = 4) const bool HAS_INSTANCES = false;
layout(constant_id = 5) const uint INSTANCE_TREE = 0u;
#define INSTANCE_ROOT INSTANCE_TREE

TABLE(SET_SCENE, 0, Nodes);
TABLE(SET_SCENE, 1, Triangles);
layout(set = SET_PASS, binding = 0, std430) readonly buffer Rays { vec4 rays[]; };   // origin, tMax; direction, unused
layout(set = SET_PASS, binding = 1, std430) readonly buffer Solid { uint solid[]; }; // per triangle: passes its alpha test
layout(set = SET_PASS, binding = 2, std430) writeonly buffer Hits { uvec4 hits[]; }; // triangle | occluded << 31, u, v, t

bool alphaPasses(uint triangle, vec2 barycentric, uint alphaSeed) { return solid[triangle] != 0u; }

#include "scene/intersect.glsl"

void main()
{
    uint index = gl_GlobalInvocationID.x;
    if (index >= uint(hits.length())) return;
    vec4 origin = rays[2u * index];
    Ray ray = Ray(origin.xyz, rays[2u * index + 1u].xyz, origin.w);
    Hit hit = closestHit(ray, 0u);
    bool blocked = TRACE_OCCLUDED ? occluded(ray, 0u) : hit.triangle != NO_HIT;
    uint triangle = hit.triangle & 0x7fffffffu;
    hits[index] = uvec4(triangle | (blocked ? 0x80000000u : 0u), floatBitsToUint(vec3(hit.barycentric, hit.t)));
}
