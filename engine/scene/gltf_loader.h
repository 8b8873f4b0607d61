#pragma once
// glTF 2.0 (.gltf, .glb) to Scene. Files are untrusted: whatever they hold, the result is a sane scene or an Error.

#include <filesystem>
#include <functional>
#include <string>

#include "engine/scene/instances.h"
#include "engine/scene/scene.h"

namespace scene
{

struct LoadOptions {
    std::function<void(const std::string& what, double fraction)>
        progress;           // may be empty; called on the caller's thread
    bool sky = true;        // a file without light gets a uniform sky; false: the caller has an environment for it
    bool animations = true; // false: they are checked for structure and not read; nothing moves
    Instancing instancing = Instancing::Auto;
    std::filesystem::path assetRoot; // buffers and textures may lie below it, too; empty: below the file's folder alone
};

// The file's default scene, in the pose that its nodes state; Scene::motion holds its animations. Throws Error: one
// sentence naming the file, the object and the value. Afterwards: finite vertices, unit normals, at least one camera,
// and light or emission (chosen by us when the file has none; Scene::warnings says so).
Scene loadGltf(const std::filesystem::path& file, const LoadOptions& options = {});

} // namespace scene
