#version 460
#extension GL_GOOGLE_include_directive : require
// Appends what the uniform block says: log[position] = value.
#include "shared/types.h"
layout(local_size_x = 1) in;
layout(set = SET_PASS, binding = 0) uniform Entry { uint position; uint value; };
layout(set = SET_PASS, binding = 1, std430) writeonly buffer Log { uint log_[]; };

void main() { log_[position] = value; }
