// Set 0, the frame: what every stage knows, with the variant's constants and the counters. Knows nothing of scenes.
#ifndef SHADERS_LIB_FRAME_GLSL
#define SHADERS_LIB_FRAME_GLSL

#include "lib/lanes.glsl"
#include "lib/random.glsl"
#include "shared/frame.h"
#include "shared/streams.h"
#include "shared/tuning.h"
#include "shared/variant.h"

#define DECLARE_CONSTANT(ID, TYPE, NAME, DEFAULT, WHAT) layout(constant_id = ID) const TYPE NAME = DEFAULT;
VARIANT_CONSTANTS(DECLARE_CONSTANT)
#undef DECLARE_CONSTANT
layout(constant_id = 65) const uint COUNTERS = COUNTERS_EACH; // set by the device (engine/gpu/tuning.h)

layout(set = SET_FRAME, binding = 0, std140) uniform Frame { FrameUniform frame; };
// 64-bit counters as (low, high) pairs.
layout(set = SET_FRAME, binding = 1, std430) buffer Counters { uint counters[]; };

void addAlone(uint counter, uint amount)
{
    if (amount == 0u) return;
    uint before = atomicAdd(counters[2u * counter], amount);
    if (before + amount < before) atomicAdd(counters[2u * counter + 1u], 1u);
}

// (What a subgroup counts in a frame is far below 2^32.)
void addToCounter(uint counter, uint amount)
{
    if (COUNTERS == COUNTERS_OFF) return;
    if (COUNTERS == COUNTERS_SUBGROUP) amount = sumInOneLane(amount);
    addAlone(counter, amount);
}

// The one place that looks for non-finite values: such a value becomes 0 and is counted, never passed on silently.
vec3 finiteOrCounted(vec3 value, uint stage)
{
    if (isFinite(value)) return value;
    addAlone(COUNTER_NONFINITE + stage, 1u); // always, and too rarely for sums to pay
    return vec3(0.0);
}

// Numbers that decide between samples: keyed by the pixel and frame that decide, never by a stored seed.
uvec4 decisionRandom(uint pixel, uint stream)
{
    return randomBlock(PathSeed(frame.frame, pixel), stream, uvec2(frame.key0, frame.key1));
}
float decisionNumber(uint pixel, uint stream) { return decisionFloat(decisionRandom(pixel, stream).x); } // [0, 1)

#endif
