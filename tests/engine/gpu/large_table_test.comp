#version 460
#extension GL_GOOGLE_include_directive : require
// Each invocation exchanges the two rows of its pair: first + i, and last - i.
#include "lib/lanes.glsl"
#include "shared/types.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool STORES_IN_STORAGE = false;
TABLE_INOUT(SET_PASS, 0, Rows);
layout(set = SET_PASS, binding = 1, std430) readonly buffer Ends { uint first; uint last; uint count; uint padding; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    uvec4 low = FETCH(Rows, first + i);
    uvec4 high = FETCH(Rows, last - i);
    STORE(Rows, first + i, high);
    STORE(Rows, last - i, low);
}
