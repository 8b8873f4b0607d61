#version 460
#extension GL_GOOGLE_include_directive : require
// values[i] = values[i] * factor + OFFSET + first lane of the table's element i.
#include "lib/lanes.glsl"
#include "shared/types.h"
layout(constant_id = 0) const uint OFFSET = 0;
layout(constant_id = 1) const uint WORKGROUP = 64;
layout(local_size_x_id = 1) in;
layout(set = SET_FRAME, binding = 0) uniform Frame { uint factor; };
TABLE(SET_SCENE, 3, Elements);
layout(set = SET_PASS, binding = 1, std430) buffer Values { uint values[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= values.length()) return;
    values[i] = values[i] * factor + OFFSET + FETCH(Elements, i).x;
}
