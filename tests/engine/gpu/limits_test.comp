#version 460
#extension GL_GOOGLE_include_directive : require
// Workgroup size and shared memory that constants set; reports the former.
#include "shared/types.h"
layout(constant_id = 0) const uint WIDTH = 8;
layout(constant_id = 1) const uint EXTRA = 3;
layout(local_size_x_id = 0, local_size_y_id = 5) in;
layout(local_size_y = 4) in;
layout(set = SET_PASS, binding = 0, std430) writeonly buffer Sizes { uvec4 sizes; };
shared vec4 rows[2 * WIDTH];
shared uint counters[EXTRA];

void main()
{
    rows[gl_LocalInvocationID.x] = vec4(gl_LocalInvocationID.x);
    if (gl_LocalInvocationID.xy == uvec2(0)) counters[0] = gl_WorkGroupSize.x * gl_WorkGroupSize.y;
    barrier();
    if (rows[0].x == 0.0) sizes = uvec4(gl_WorkGroupSize, counters[0]);
}
