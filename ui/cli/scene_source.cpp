#include "ui/cli/scene_source.h"

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/scene/environment.h"
#include "engine/scene/gltf_loader.h"
#include "engine/scene/procedural.h"

#include <cstdio>

namespace ui
{

namespace
{

bool isGltf(const std::string& file)
{
    const std::string extension = files::extensionOf(file);
    return extension == ".gltf" || extension == ".glb";
}

scene::Scene load(const SceneSource& source, bool sky, const LoadProgress& progress)
{
    std::string names;
    for (const scene::BuiltInScene& builtIn : scene::builtInScenes()) {
        if (source.name == builtIn.name) return builtIn.make();
        names += (names.empty() ? "" : ", ") + std::string(builtIn.name);
    }
    if (!isGltf(source.name))
        throw Error("There is no scene \"{}\": it is neither a .gltf or .glb file nor one of: {}.", source.name, names);
    return scene::loadGltf(source.name, {.progress = progress, .sky = sky, .assetRoot = source.assetRoot});
}

} // namespace

CLI::Option* addSceneOptions(CLI::App& app, SceneSource& source, const std::string& doc)
{
    app.add_option(
           "--asset-root", source.assetRoot,
           "The scene's buffers and textures may lie anywhere below this directory, as in \"../textures/x.png\"; "
           "without it, only below the scene's own folder. Others are refused, and links that lead to others.")
        ->option_text("DIR");
    return app.add_option("SCENE", source.name, doc);
}

scene::Scene openScene(const SceneSource& source, const passes::Settings& settings, const LoadProgress& progress)
{
    scene::Scene scene = load(source, settings.environment.empty(), progress);
    scene::setEnvironment(scene, settings.environment, settings.environmentScale);
    return scene;
}

scene::Scene openScene(const SceneSource& source, const passes::Settings& settings, Progress& progress)
{
    scene::Scene scene = openScene(source, settings,
                                   [&](const std::string& what, double fraction) { progress.show(what, fraction, 1); });
    progress.clear();
    for (const std::string& warning : scene.warnings) std::fprintf(stderr, "Warning: %s\n", warning.c_str());
    return scene;
}

} // namespace ui
