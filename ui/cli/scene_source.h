#pragma once
// What SCENE means on the command line.

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "engine/scene/scene.h"
#include "passes/settings.h"
#include "ui/cli/progress.h"

namespace ui
{

struct SceneSource {
    std::string name;      // of a built-in scene, or of a .gltf or .glb file
    std::string assetRoot; // below which its files may lie, beside its own folder; empty: nowhere else

    bool operator==(const SceneSource&) const = default;
};

constexpr const char* SCENE_DOC = "A .gltf or .glb file, or a built-in scene (info --scenes lists them).";

// SCENE and --asset-root; `source` must live until the options are read. The option that is returned is SCENE.
CLI::Option* addSceneOptions(CLI::App& app, SceneSource& source, const std::string& doc);

// With the environment that the settings ask for. Its warnings go to stderr, one line each. Throws Error.
scene::Scene openScene(const SceneSource& source, const passes::Settings& settings, Progress& progress);

// The same without a terminal: progress goes to `progress` (what, fraction), warnings stay in the scene.
using LoadProgress = std::function<void(const std::string& what, double fraction)>;
scene::Scene openScene(const SceneSource& source, const passes::Settings& settings, const LoadProgress& progress);

} // namespace ui
