#pragma once
// What people call SCENE on the command line: a built-in name, or a .gltf or .glb file.

#include <string>

#include "engine/scene/gltf_loader.h"
#include "engine/scene/scene.h"

namespace scene
{

struct OpenOptions {
    std::string environment; // file, replaces the scene's own; may be empty
    float environmentScale = 1;
    std::function<void(const std::string& what, double fraction)> progress; // may be empty
};

// Built-in names win over files of that name. Throws Error.
Scene openScene(const std::string& nameOrFile, const OpenOptions& options = {});

} // namespace scene
