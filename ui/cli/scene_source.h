#pragma once
// What SCENE means on the command line.

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "engine/scene/instances.h"
#include "engine/scene/scene.h"
#include "passes/settings.h"
#include "ui/cli/progress.h"

namespace ui
{

struct SceneSource {
    std::string name;           // of a built-in scene, or of a .gltf or .glb file
    std::string assetRoot;      // below which its files may lie, beside its own folder; empty: nowhere else
    std::optional<double> time; // seconds; none: at rest, or 0 where an animation is named
    std::string animation;      // a name, an index, "all" or "off"; empty: all where a time is given
    scene::Instancing instancing = scene::Instancing::Auto;

    bool atRest() const { return !time && animation.empty(); }
    // All but name and asset root, as metadata, like settings.
    std::vector<std::pair<std::string, std::string>> toText() const;

    bool operator==(const SceneSource&) const = default;
};

// Indices; none: there is none, or "off". Throws Error.
std::vector<uint32_t> chosenAnimations(const scene::Scene& scene, const SceneSource& source);

constexpr const char* SCENE_DOC = "A .gltf or .glb file, or a built-in scene (info --scenes lists them).";

// SCENE, --asset-root, --instances, --time and --animation; `source` must live until the options are read. The option
// that is returned is SCENE.
CLI::Option* addSceneOptions(CLI::App& app, SceneSource& source, const std::string& doc);

// In its pose, with the environment that the settings ask for. Its warnings go to stderr, one line each. Throws Error.
scene::Scene openScene(const SceneSource& source, const passes::Settings& settings, Progress& progress);

// The same without a terminal: progress goes to `progress` (what, fraction), warnings stay in the scene.
using LoadProgress = std::function<void(const std::string& what, double fraction)>;
scene::Scene openScene(const SceneSource& source, const passes::Settings& settings, const LoadProgress& progress);

} // namespace ui
