// Set 0 (the frame) and set 1 (the scene), and the variant's constants: what every stage binds.
#ifndef SHADERS_SCENE_BINDINGS_GLSL
#define SHADERS_SCENE_BINDINGS_GLSL

#include "lib/random.glsl"
#include "lib/table.glsl"
#include "shared/frame.h"
#include "shared/scene.h"
#include "shared/streams.h"
#include "shared/variant.h"

#define DECLARE_CONSTANT(ID, TYPE, NAME, DEFAULT, WHAT) layout(constant_id = ID) const TYPE NAME = DEFAULT;
VARIANT_CONSTANTS(DECLARE_CONSTANT)
#undef DECLARE_CONSTANT

layout(set = SET_FRAME, binding = 0, std140) uniform Frame { FrameUniform frame; };
// 64-bit counters as (low, high) pairs.
layout(set = SET_FRAME, binding = 1, std430) buffer Counters { uint counters[]; };

TABLE(SET_SCENE, 0, Nodes);
TABLE(SET_SCENE, 1, Triangles);
TABLE(SET_SCENE, 2, Attributes);
TABLE(SET_SCENE, 3, Texels);
TABLE(SET_SCENE, 4, SceneData);
layout(set = SET_SCENE, binding = 5, std140) uniform Scene { SceneUniform scene; };

void addToCounter(uint counter, uint amount)
{
    if (amount == 0u) return;
    uint before = atomicAdd(counters[2u * counter], amount);
    if (before + amount < before) atomicAdd(counters[2u * counter + 1u], 1u);
}

// The one place that looks for non-finite values: such a value becomes 0 and is counted, never passed on silently.
vec3 finiteOrCounted(vec3 value, uint stage)
{
    if (!any(isnan(value)) && !any(isinf(value))) return value;
    addToCounter(COUNTER_NONFINITE + stage, 1u);
    return vec3(0.0);
}

#endif
