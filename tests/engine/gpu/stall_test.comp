#version 460
#extension GL_GOOGLE_include_directive : require
// Never ends.
#include "shared/types.h"
layout(local_size_x = 1) in;
layout(set = SET_PASS, binding = 0, std430) volatile buffer Values { uint values[]; };

void main()
{
    while (values[1] == 0u) values[0] = values[0] * 1664525u + 1u;
}
