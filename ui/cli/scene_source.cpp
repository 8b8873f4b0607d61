#include "ui/cli/scene_source.h"

#include "engine/base/error.h"
#include "engine/scene/environment.h"
#include "engine/scene/gltf_loader.h"
#include "engine/scene/procedural.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace ui
{

namespace
{

bool isGltf(const std::filesystem::path& file)
{
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
    return extension == ".gltf" || extension == ".glb";
}

scene::Scene load(const std::string& nameOrFile, bool sky, const LoadProgress& progress)
{
    std::string names;
    for (const scene::BuiltInScene& builtIn : scene::builtInScenes()) {
        if (nameOrFile == builtIn.name) return builtIn.make();
        names += (names.empty() ? "" : ", ") + std::string(builtIn.name);
    }
    if (!isGltf(nameOrFile))
        throw Error("There is no scene \"{}\": it is neither a .gltf or .glb file nor one of: {}.", nameOrFile, names);
    return scene::loadGltf(nameOrFile, {.progress = progress, .sky = sky});
}

} // namespace

scene::Scene openScene(const std::string& nameOrFile, const passes::Settings& settings, const LoadProgress& progress)
{
    scene::Scene scene = load(nameOrFile, settings.environment.empty(), progress);
    scene::setEnvironment(scene, settings.environment, settings.environmentScale);
    return scene;
}

scene::Scene openScene(const std::string& nameOrFile, const passes::Settings& settings, Progress& progress)
{
    scene::Scene scene = openScene(nameOrFile, settings,
                                   [&](const std::string& what, double fraction) { progress.show(what, fraction, 1); });
    progress.clear();
    for (const std::string& warning : scene.warnings) std::fprintf(stderr, "Warning: %s\n", warning.c_str());
    return scene;
}

} // namespace ui
