// What drivers want, so that the algorithm reads without it: loops, tables, arithmetic to the bit, sums over lanes. What each
// gained or mended is in tests/bench/LOG.md; which device gets what, in engine/gpu/tuning.cpp.
//
// Mesa's CPU driver runs 8 lanes under masks: an `if` skips nothing, only loops branch. Its traps (22.3):
// - From a loop that lanes leave at different times come out right only variables that each round makes from what they were
//   before it. So what is assigned there is guarded by the loop's own condition.
// - Arrays lie in memory unless all their indices are known once loops are unrolled, and only those that count upwards are.
// And glslang 12 can neither copy nor initialize arrays sized by a specialisation constant.
#ifndef SHADERS_LIB_LANES_GLSL
#define SHADERS_LIB_LANES_GLSL

#extension GL_KHR_shader_subgroup_arithmetic : require

#include "shared/tuning.h"

// ---------------------------------------------------------------------------------------------------------------- loops
// A loop that tests at its start runs its body once more than any lane needs. So loops test at their end, and the body must be
// harmless where the condition does not hold at the start. SwiftShader compiles a nest of such loops wrongly: there, and where
// an `if` skips what it should, they test at their start.
layout(constant_id = 64) const bool LOOPS_TEST_AT_END = false; // set by the device (engine/gpu/tuning.h)

// A `continue` would skip the test at the end.
#define LOOP_BEGIN(CONDITION) while (true) { if (!LOOPS_TEST_AT_END && !(CONDITION)) break;
#define LOOP_END(CONDITION) if (LOOPS_TEST_AT_END && !(CONDITION)) break; }

// VALUE = ARRAY[INDEX], by an unrolled loop over COUNT elements: the array stays in registers.
#define PICK(VALUE, ARRAY, COUNT, INDEX)                                                                               \
    VALUE = ARRAY[0];                                                                                                  \
    for (uint i = 1u; i < COUNT; ++i)                                                                                  \
        if (uint(INDEX) == i) VALUE = ARRAY[i]

// --------------------------------------------------------------------------------------------------------------- tables
// A table is an array of uvec4. The build compiles every shader twice, with and without TABLES_IN_STORAGE, and gpu::Device picks
// (Limits::tablesAreTexelBuffers). Texel buffers fetched as textures are 2.3 times as fast as storage buffers on lavapipe, and
// a tenth faster still when loaded as images, which it inlines. Drivers with small limits use storage buffers.
// Storing there is the other way round: through a storage buffer it takes half as long as through an image. So a table that
// is written has two bindings to the same memory, and STORES_IN_STORAGE (shared/variant.h) says through which it is written:
// through the image where pictures are larger than a storage binding.
#ifdef TABLES_IN_STORAGE
#define TABLE_OF(ACCESS, SET, BINDING, NAME)                                                                           \
    layout(set = SET, binding = BINDING, std430) ACCESS buffer NAME { uvec4 NAME##Elements[]; }
#define TABLE_OUT(SET, BINDING, NAME) TABLE_OF(writeonly restrict, SET, BINDING, NAME)
#define TABLE_INOUT(SET, BINDING, NAME) TABLE_OF(restrict, SET, BINDING, NAME)
#define FETCH(NAME, INDEX) NAME##Elements[INDEX]
#define STORE(NAME, INDEX, VALUE) NAME##Elements[INDEX] = VALUE
#else
#define TABLE_OF(ACCESS, SET, BINDING, NAME)                                                                           \
    layout(set = SET, binding = BINDING, rgba32ui) uniform ACCESS uimageBuffer NAME
#define STORES_OF(SET, BINDING, NAME)                                                                                  \
    layout(set = SET, binding = BINDING + STORES_BINDING, std430) writeonly buffer NAME##Stores                        \
    {                                                                                                                  \
        uvec4 NAME##StoresElements[];                                                                                  \
    }
#define TABLE_OUT(SET, BINDING, NAME) TABLE_OF(writeonly, SET, BINDING, NAME); STORES_OF(SET, BINDING, NAME)
#define TABLE_INOUT(SET, BINDING, NAME) TABLE_OF(, SET, BINDING, NAME); STORES_OF(SET, BINDING, NAME)
#define FETCH(NAME, INDEX) imageLoad(NAME, int(INDEX))
#define STORE(NAME, INDEX, VALUE)                                                                                      \
    if (STORES_IN_STORAGE) NAME##StoresElements[INDEX] = VALUE;                                                        \
    else imageStore(NAME, int(INDEX), VALUE)
#endif
#define TABLE(SET, BINDING, NAME) TABLE_OF(readonly restrict, SET, BINDING, NAME)

// Tables of 32-bit words, and rows that hold a color.
#define FETCH_WORD(NAME, INDEX) FETCH(NAME, (INDEX) >> 2u)[(INDEX) & 3u]
uvec4 rowOf(vec3 color, uint word) { return uvec4(floatBitsToUint(color), word); }
uvec4 rowOf(vec3 color) { return rowOf(color, 0u); }
vec3 colorOfRow(uvec4 row) { return uintBitsToFloat(row.xyz); }
#define colorIn(NAME, ROW) colorOfRow(FETCH(NAME, ROW))

// ----------------------------------------------------------------------------------------------------------- arithmetic
// For `precise` variables: one instruction each. min and max, which must heed NaN, take several.
#define LESSER(X, Y) (X) < (Y) ? (X) : (Y)
#define GREATER(X, Y) (X) > (Y) ? (X) : (Y)

// clamp(), but NaN stays NaN, so that it is counted where it arrives: clamp() makes a number of it.
float within(float x, float low, float high) { return x < low ? low : x > high ? high : x; }

// a + b, where a is the larger, and what rounding takes from it (Kahan). Compilers must neither fuse nor reorder: `precise`.
float sumOf(float a, float b, out float roundedOff)
{
    precise float sum = a + b;
    precise float lost = b - (sum - a);
    roundedOff = lost;
    return sum;
}

// By its bits: compilers that are told of no such values take isnan and isinf away.
bool isFinite(float value) { return (floatBitsToUint(value) & 0x7f800000u) != 0x7f800000u; }
bool isFinite(vec3 value) { return isFinite(value.x) && isFinite(value.y) && isFinite(value.z); }

// ---------------------------------------------------------------------------------------------------------------- lanes
// Of whichever lanes arrive here together one gets the sum, the others 0. No control flow stands between sum and choice, so
// that both are among the same ones.
uint sumInOneLane(uint amount)
{
    uint sum = subgroupAdd(amount);
    return subgroupElect() ? sum : 0u;
}

#endif
