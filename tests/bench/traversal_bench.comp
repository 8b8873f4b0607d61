#version 460
#extension GL_GOOGLE_include_directive : require
// Traces the given rays and stores what it finds: nothing but traversal is timed.
#include "lib/lanes.glsl"
#include "shared/types.h"
layout(local_size_x = 64) in;

layout(constant_id = 0) const bool ANY_HIT = false;
layout(constant_id = 1) const uint STACK_SIZE = 32u;
layout(constant_id = 2) const bool STACK_IN_REGISTERS = false;
const bool HAS_ALPHA = false;
const bool HAS_INSTANCES = false;

TABLE(SET_SCENE, 0, Nodes);
TABLE(SET_SCENE, 1, Triangles);
TABLE(SET_PASS, 0, Rays); // origin, tMax; direction, unused. A table: loads are not what is to be timed
layout(set = SET_PASS, binding = 1, std430) writeonly buffer Hits { uvec4 hits[]; }; // triangle or occluded, u, v, t

bool alphaPasses(uint triangle, vec2 barycentric, uint alphaSeed) { return true; }

#include "scene/intersect.glsl"

void main()
{
    uint index = gl_GlobalInvocationID.x;
    if (index >= uint(hits.length())) return;
    vec4 origin = uintBitsToFloat(FETCH(Rays, 2u * index));
    Ray ray = Ray(origin.xyz, uintBitsToFloat(FETCH(Rays, 2u * index + 1u).xyz), origin.w);
    if (ANY_HIT) {
        hits[index] = uvec4(occluded(ray, 0u) ? 0u : NO_HIT, 0u, 0u, 0u);
    } else {
        Hit hit = closestHit(ray, 0u);
        hits[index] = uvec4(hit.triangle, floatBitsToUint(vec3(hit.barycentric, hit.t)));
    }
}
