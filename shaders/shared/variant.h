// What a scene and the settings need: specialisation constants. What is false is not compiled. One line each:
// X(id, type, NAME, default, "what it compiles in"). GLSL makes constants of it, C++ the fields of passes::Variant.
#ifndef SHADERS_SHARED_VARIANT_H
#define SHADERS_SHARED_VARIANT_H

#include "shared/types.h"

// What occurs in a scene: the fields of scene::SceneFeatures.
#define SCENE_FEATURES(X)                                                                                              \
    X(3, bool, HAS_ALPHA, true, "alpha tests during traversal")                                                        \
    X(4, bool, HAS_SPECULAR, true, "specular reflection lobes")                                                        \
    X(5, bool, HAS_ROUGH, true, "GGX: specular lobes of finite width")                                                 \
    X(6, bool, HAS_DIRAC, true, "perfect mirrors and clear glass")                                                     \
    X(7, bool, HAS_TRANSMISSION, true, "transmission lobes")                                                           \
    X(8, bool, HAS_SOLID, true, "refraction into closed bodies")                                                       \
    X(9, bool, HAS_EMISSIVE, true, "emissive triangles")                                                               \
    X(10, bool, HAS_PUNCTUAL, true, "point and spot lights")                                                           \
    X(11, bool, HAS_DIRECTIONAL, true, "directional lights")                                                           \
    X(12, bool, HAS_ENVIRONMENT, true, "environment map")                                                              \
    X(13, bool, HAS_UNLIT, true, "unlit materials")                                                                    \
    X(14, bool, HAS_VERTEX_COLORS, true, "vertex colors")                                                              \
    X(15, bool, HAS_SECOND_UV, true, "second texture coordinates")                                                     \
    X(16, bool, HAS_TEXTURE_TRANSFORM, true, "texture transforms")                                                     \
    X(17, bool, HAS_BASE_COLOR_TEXTURE, true, "base color textures")                                                   \
    X(18, bool, HAS_METALLIC_ROUGHNESS_TEXTURE, true, "metallic-roughness textures")                                   \
    X(19, bool, HAS_NORMAL_MAP, true, "normal maps")                                                                   \
    X(20, bool, HAS_EMISSIVE_TEXTURE, true, "emissive textures")                                                       \
    X(21, bool, HAS_TRANSMISSION_TEXTURE, true, "transmission textures")                                               \
    X(22, bool, HAS_SPECULAR_TEXTURE, true, "specular weight and color textures")                                      \
    X(23, bool, HAS_MANY_MATERIALS, true, "more than one material")                                                    \
    X(29, bool, HAS_DEEP_TEXTURE, true, "textures of 16 bits a sample")                                                \
    X(34, bool, HAS_INSTANCES, false, "meshes that are stored once and stand in many places")

#define VARIANT_CONSTANTS(X)                                                                                           \
    X(0, uint, MAX_BOUNCES, 5u, "scattering events on a path")                                                         \
    X(1, bool, BOX_FILTER, false, "jittered camera rays")                                                              \
    X(2, bool, ORTHOGRAPHIC, false, "parallel camera rays")                                                            \
    SCENE_FEATURES(X)                                                                                                  \
    X(24, uint, RESERVOIR_COUNT, 1u, "reservoirs of a pixel")                                                          \
    X(25, uint, SHIFT_MAP, 0u, "shift map: 0 random replay, 1 reconnection, 2 hybrid")                                 \
    X(26, bool, SAME_VIEW, false, "temporal reuse without shifts, for frames of a resting camera")                     \
    X(27, uint, STACK_SIZE, 32u, "entries of the traversal stack, for the depth of the scene's tree")                  \
    X(28, bool, STACK_IN_REGISTERS, false, "traversal stack in registers: for drivers that run lanes under masks")     \
    X(30, uint, COLOR_READING, 0u,                                                                                     \
      "how color is read from reservoirs: 0 off the chosen samples, 1 weighted over all that were merged last, 2 as "  \
      "control variate of an estimate beside them")                                                                    \
    X(31, bool, ONE_CHANNEL, false, "contributions kept as one number, for targets of one channel alone")              \
    X(32, bool, TWO_WORLDS, false, "a scene that moves: as it is in this frame, and as it was in the one before")      \
    X(33, bool, BETWEEN_WORLDS, false, "temporal reuse from a frame in which the scene was another")                   \
    X(35, bool, STORES_IN_STORAGE, false, "tables written as storage buffers, which must hold them")                   \
    X(36, uint, MUTATION, 0u, "what history's samples are mutated by before they are merged: 0 nothing, 1 new paths")

SHARED_BEGIN

// Values of SHIFT_MAP.
SHARED_CONST uint SHIFT_REPLAY = 0u;
SHARED_CONST uint SHIFT_RECONNECTION = 1u;
SHARED_CONST uint SHIFT_HYBRID = 2u;

// Values of COLOR_READING.
SHARED_CONST uint COLOR_CHOSEN = 0u;
SHARED_CONST uint COLOR_WEIGHTED = 1u;
SHARED_CONST uint COLOR_VARIATE = 2u;

// Values of MUTATION.
SHARED_CONST uint MUTATION_OFF = 0u;
SHARED_CONST uint MUTATION_FREE = 1u;

SHARED_END

#endif
