// A path of the path tree: the number k of scattering events, and how the light was found. Ids ascend as the walk meets them.
#ifndef SHADERS_RESTIR_PATH_ID_GLSL
#define SHADERS_RESTIR_PATH_ID_GLSL

const uint BY_LIGHT = 0u;   // next-event estimation at x_k
const uint BY_SCATTER = 1u; // the scattered ray of x_k met an emitter or the environment
uint makePathId(uint k, uint technique) { return k << 1u | technique; }
uint scatteringsOf(uint pathId) { return pathId >> 1u; }
uint techniqueOf(uint pathId) { return pathId & 1u; }

#endif
