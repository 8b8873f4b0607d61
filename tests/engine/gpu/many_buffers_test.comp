#version 460
#extension GL_GOOGLE_include_directive : require
// One storage buffer more than is portable: eleven blocks and a table.
#include "lib/table.glsl"
#include "shared/types.h"
layout(local_size_x = 1) in;
TABLE(SET_SCENE, 0, Elements);
#define BLOCK(I) layout(set = SET_PASS, binding = I, std430) buffer Block##I { uint value##I; }
BLOCK(0);
BLOCK(1);
BLOCK(2);
BLOCK(3);
BLOCK(4);
BLOCK(5);
BLOCK(6);
BLOCK(7);
BLOCK(8);
BLOCK(9);
BLOCK(10);

void main()
{
    value0 = value1 + value2 + value3 + value4 + value5 + value6 + value7 + value8 + value9 + value10 + FETCH(Elements, 0).x;
}
