#version 460
#extension GL_GOOGLE_include_directive : require
// Reads every member of the shared structs, of the first and of the second in an array: offsets and sizes.
#include "layout_test.h"
#include "shared/frame.h"
#include "shared/scene.h"
layout(local_size_x = 2) in;

// The names say where the structs are in the program: both in uniform blocks.
layout(set = SET_PASS, binding = 0, std140) uniform Frames { FrameUniform frames[2]; };
layout(set = SET_PASS, binding = 1, std140) uniform Scenes { SceneUniform scenes[2]; };
layout(set = SET_PASS, binding = 2, std430) writeonly buffer Words { uint words[]; };

uint bits(float x) { return floatBitsToUint(x); }
uint bits(uint x) { return x; }

void main()
{
    uint element = gl_LocalInvocationIndex;
#define COUNT(MEMBER) +1u
    uint next = element * (0u FRAME_MEMBERS(COUNT) SCENE_MEMBERS(COUNT));
#define WRITE_FRAME(MEMBER) words[next++] = bits(frames[element].MEMBER);
#define WRITE_SCENE(MEMBER) words[next++] = bits(scenes[element].MEMBER);
    FRAME_MEMBERS(WRITE_FRAME)
    SCENE_MEMBERS(WRITE_SCENE)
}
