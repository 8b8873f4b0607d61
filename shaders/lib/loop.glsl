// Loops as drivers like them. Mesa's CPU driver runs 8 lanes under masks: an `if` skips nothing, and a loop that tests at its
// start runs its body once more than any lane needs. So loops test at their end, and the body must be harmless where the
// condition does not hold at the start. From a loop that lanes leave at different times, Mesa 22.3 brings out right only
// variables that each round makes from what they were before it. SwiftShader compiles a nest of loops that test at their end
// wrongly: there, and where an `if` skips what it should, they test at their start (tests/bench/LOG.md).
#ifndef SHADERS_LIB_LOOP_GLSL
#define SHADERS_LIB_LOOP_GLSL

layout(constant_id = 64) const bool LOOPS_TEST_AT_END = false; // set by the device (engine/gpu/tuning.h)

// A `continue` would skip the test at the end.
#define LOOP_BEGIN(CONDITION) while (true) { if (!LOOPS_TEST_AT_END && !(CONDITION)) break;
#define LOOP_END(CONDITION) if (LOOPS_TEST_AT_END && !(CONDITION)) break; }

#endif
