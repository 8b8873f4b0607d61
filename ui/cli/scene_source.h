#pragma once
// What SCENE means on the command line.

#include <functional>
#include <string>

#include "engine/scene/scene.h"
#include "passes/settings.h"
#include "ui/cli/progress.h"

namespace ui
{

// A built-in scene by name, or a .gltf/.glb file; with the environment that the settings ask for. Its warnings go to
// stderr, one line each. Throws Error.
scene::Scene openScene(const std::string& nameOrFile, const passes::Settings& settings, Progress& progress);

// The same without a terminal: progress goes to `progress` (what, fraction), warnings stay in the scene.
using LoadProgress = std::function<void(const std::string& what, double fraction)>;
scene::Scene openScene(const std::string& nameOrFile, const passes::Settings& settings, const LoadProgress& progress);

} // namespace ui
