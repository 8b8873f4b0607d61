// Loops as drivers like them. Mesa's CPU driver runs 8 lanes under masks: an `if` skips nothing, and a loop that tests at its
// start runs its body once more than any lane needs. So loops test at their end, and the body must be harmless where the
// condition does not hold at the start. From a loop that lanes leave at different times, Mesa 22.3 brings out right only
// variables that each round makes from what they were before it. SwiftShader, which reads tables from storage buffers,
// compiles a nest of loops that test at their end wrongly: there they test at their start (tests/bench/LOG.md).
#ifndef SHADERS_LIB_LOOP_GLSL
#define SHADERS_LIB_LOOP_GLSL

#ifdef TABLES_IN_STORAGE
#define LOOP_BEGIN(CONDITION) while (CONDITION) {
#define LOOP_END(CONDITION) }
#else
#define LOOP_BEGIN(CONDITION) do {
#define LOOP_END(CONDITION) } while (CONDITION);
#endif

#endif
