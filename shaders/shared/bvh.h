// The 8-wide compressed BVH as both languages see it. Built by engine/scene/bvh.cpp, read by
// shaders/scene/intersect.glsl. After Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through
// Compressed Wide BVHs", 2017, with masks instead of per-child meta bytes.
//
// Table "Nodes", BVH_NODE_STRIDE elements a node. Child slot s (0..7) lies towards the corner of its node that has
// x, y, z high where bits 0, 1, 2 of s are set.
//   0: xyz  the grid's corner p (float bits)
//      w    biased exponents of the grid's steps: x | y << 8 | z << 16. Box plane = p + byte * step
//   1: x    masks: bit 24+s: slot s is a node; bit 3s+k: slot s is a leaf with a k-th record, k < 3; none: empty
//      y    b << 8: the node in slot s is node b + s
//      z    index of the first record; the others follow in order of mask bits
//   2: lower x of slots 0..3, 4..7; lower y    (one byte a slot, lowest byte first)
//   3: lower z; upper x
//   4: upper y; upper z
// Node 0 is the root, its grid covers the scene. Children of other nodes fill the gaps that b + s leaves.
//
// Table "Triangles", BVH_RECORD_STRIDE elements a record: one or two triangles. xyz of element i is corner r_i (float
// bits). The first triangle is r_0 r_1 r_2, the second, across their common edge, r_3 r_2 r_1; there is none where r_3
// is r_1. Each begins with one of its own vertices: r_0 is vertex `turn` of the first triangle, r_3 of the second.
//   0: w    index of the first triangle, with BVH_ALPHA_FLAG where its alpha must be asked: such a one is alone
//   1: w    index of the second triangle
//   2: w    turn of the first triangle, 0 to 2
//   3: w    turn of the second triangle
#ifndef SHADERS_SHARED_BVH_H
#define SHADERS_SHARED_BVH_H

#include "types.h"

SHARED_BEGIN
SHARED_CONST uint BVH_NODE_STRIDE = 5u;
SHARED_CONST uint BVH_RECORD_STRIDE = 4u;
SHARED_CONST uint BVH_MAX_NODES = 1u << 24; // b << 8 must not overflow
SHARED_CONST uint BVH_STACK_SIZE = 32u;     // entries; the builder keeps every tree within it
SHARED_CONST uint BVH_ALPHA_FLAG = 0x80000000u;
SHARED_END

#endif
