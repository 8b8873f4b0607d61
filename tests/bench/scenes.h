#pragma once
// Scenes of benchmarks, by name.

#include <string>

#include "engine/scene/gltf_loader.h"
#include "engine/scene/procedural.h"

// A built-in name, or a .gltf or .glb file. Throws Error.
inline scene::Scene loadScene(const std::string& name)
{
    for (const scene::BuiltInScene& scene : scene::builtInScenes())
        if (name == scene.name) return scene.make();
    return scene::loadGltf(name);
}
