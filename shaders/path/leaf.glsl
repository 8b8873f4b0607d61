// A leaf of the path tree: the number k of scattering events, and how the light was found. Leaves are ordered as the walk
// meets them.
#ifndef SHADERS_PATH_LEAF_GLSL
#define SHADERS_PATH_LEAF_GLSL

const uint BY_LIGHT = 0u;   // next-event estimation at x_k
const uint BY_SCATTER = 1u; // the scattered ray of x_k met an emitter or the environment
uint makeLeaf(uint k, uint technique) { return k << 1u | technique; }
uint scatteringsOf(uint leaf) { return leaf >> 1u; }

#endif
