#version 460
#extension GL_GOOGLE_include_directive : require
// Counts in control flow where invocations part, and looks for values that are not finite.
#include "lib/frame.glsl"
layout(local_size_x = 64) in;

layout(set = SET_PASS, binding = 0, std430) readonly buffer Amounts { uint amounts[]; };
layout(set = SET_PASS, binding = 1, std430) readonly buffer Values { vec4 values[]; };
layout(set = SET_PASS, binding = 2, std430) writeonly buffer Results { vec4 results[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(amounts.length())) return; // the last workgroup is not full
    results[i] = vec4(finiteOrCounted(values[i].xyz, STAGE_TEMPORAL), 0.0);
    uint amount = amounts[i];
    addToCounter(0u, amount);
    if (amount % 3u == 0u) addToCounter(1u, amount);
    else addToCounter(2u, 1u);
    for (uint round = 0u; round < amount % 7u; ++round) addToCounter(3u, round); // each leaves when it is done
    if (amount % 5u == 1u) return;
    addToCounter(4u, amount % 2u);
}
