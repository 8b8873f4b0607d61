// A table: a read-only array of uvec4. Layout differs by device class, so it is a preprocessor matter: the build compiles
// every shader twice, with and without TABLES_IN_STORAGE, and gpu::Device picks (Limits::tablesAreTexelBuffers).
// Texel buffers fetched as textures are 2.3 times as fast as storage buffers on lavapipe, and a tenth faster still when loaded as
// images, which it inlines. Drivers with small limits use storage buffers (engine/gpu/adapter.cpp).
#ifndef SHADERS_LIB_TABLE_GLSL
#define SHADERS_LIB_TABLE_GLSL

#ifdef TABLES_IN_STORAGE
#define TABLE_OF(ACCESS, SET, BINDING, NAME)                                                                           \
    layout(set = SET, binding = BINDING, std430) ACCESS buffer NAME { uvec4 NAME##Elements[]; }
#define FETCH(NAME, INDEX) NAME##Elements[INDEX]
#define STORE(NAME, INDEX, VALUE) NAME##Elements[INDEX] = VALUE
#else
#define TABLE_OF(ACCESS, SET, BINDING, NAME)                                                                           \
    layout(set = SET, binding = BINDING, rgba32ui) uniform ACCESS uimageBuffer NAME
#define FETCH(NAME, INDEX) imageLoad(NAME, int(INDEX))
#define STORE(NAME, INDEX, VALUE) imageStore(NAME, int(INDEX), VALUE)
#endif
#define TABLE(SET, BINDING, NAME) TABLE_OF(readonly restrict, SET, BINDING, NAME)
#define TABLE_OUT(SET, BINDING, NAME) TABLE_OF(writeonly restrict, SET, BINDING, NAME)
#define TABLE_INOUT(SET, BINDING, NAME) TABLE_OF(restrict, SET, BINDING, NAME)

// Tables of 32-bit words, and rows that hold a color.
#define FETCH_WORD(NAME, INDEX) FETCH(NAME, (INDEX) >> 2u)[(INDEX) & 3u]
#define colorIn(NAME, ROW) uintBitsToFloat(FETCH(NAME, ROW).xyz)
uvec4 rowOf(vec3 color) { return uvec4(floatBitsToUint(color), 0u); }

#endif
