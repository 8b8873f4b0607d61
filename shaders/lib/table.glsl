// A table: a read-only array of uvec4. Layout differs by device class, so it is a preprocessor matter: the build compiles
// every shader twice, with and without TABLES_IN_STORAGE, and gpu::Device picks (Limits::tablesAreTexelBuffers).
// Texel buffers fetched as textures are 2.3 times as fast as storage buffers on lavapipe, and a tenth faster still when loaded as
// images, which it inlines. Drivers with small limits use storage buffers (engine/gpu/adapter.cpp).
#ifndef SHADERS_LIB_TABLE_GLSL
#define SHADERS_LIB_TABLE_GLSL

#ifdef TABLES_IN_STORAGE
#define TABLE(SET, BINDING, NAME)                                                                                      \
    layout(set = SET, binding = BINDING, std430) readonly buffer NAME { uvec4 NAME##Elements[]; }
#define FETCH(NAME, INDEX) NAME##Elements[INDEX]
#else
#define TABLE(SET, BINDING, NAME) layout(set = SET, binding = BINDING, rgba32ui) uniform readonly restrict uimageBuffer NAME
#define FETCH(NAME, INDEX) imageLoad(NAME, int(INDEX))
#endif

#endif
