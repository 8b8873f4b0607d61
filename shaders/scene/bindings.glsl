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
layout(set = SET_SCENE, binding = 5, std140) uniform Scene { SceneUniform worlds[2]; };

// The world that everything is read from and traced in: the frame's own, unless a stage turns to the one before.
uint world = frame.world;
#define scene worlds[TWO_WORLDS ? world : 0u]
#define TREE_ROOT (TWO_WORLDS ? scene.rootNode : 0u)
#define INSTANCE_ROOT scene.instanceRoot
#define TREE_RADIUS (TWO_WORLDS ? scene.radius : 0.0) // boxes of a tree that is refitted depend on the poses before

// Between frames that show the same world, that is the one before, too.
void enterWorld(bool previous)
{
    if (TWO_WORLDS) world = previous && BETWEEN_WORLDS ? 1u - frame.world : frame.world;
}

#endif
