#version 460
#extension GL_GOOGLE_include_directive : require
// Directions of texels, and texels of directions.
#include "scene/bindings.glsl"
layout(local_size_x = 64) in;

layout(set = SET_PASS, binding = 0, std430) readonly buffer Queries { vec4 queries[]; }; // texel, place in it; or a direction
layout(set = SET_PASS, binding = 1, std430) writeonly buffer Results { vec4 results[]; };
// Two rows a query: the direction of that place in that texel, 0; the texels of that direction and of the query's own.

#include "scene/camera.glsl"
#include "scene/lights.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(queries.length())) return;
    vec4 query = queries[i];
    vec3 direction = texelDirection(uvec2(max(query.xy, 0.0)), query.zw);
    results[2u * i] = vec4(direction, 0.0);
    results[2u * i + 1u] = vec4(vec2(environmentTexel(direction)), vec2(environmentTexel(query.xyz)));
}
