// Set 1, the scene, besides set 0: what every stage that traces binds.
#ifndef SHADERS_SCENE_BINDINGS_GLSL
#define SHADERS_SCENE_BINDINGS_GLSL

#include "lib/frame.glsl"
#include "shared/scene.h"

TABLE(SET_SCENE, 0, Nodes);
TABLE(SET_SCENE, 1, Triangles);
TABLE(SET_SCENE, 2, Attributes);
TABLE(SET_SCENE, 3, Texels);
TABLE(SET_SCENE, 4, SceneData);
layout(set = SET_SCENE, binding = 5, std140) uniform Scene { SceneUniform scene; };

#endif
