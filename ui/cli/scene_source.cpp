#include "ui/cli/scene_source.h"

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/scene/environment.h"
#include "engine/scene/gltf_loader.h"
#include "engine/scene/motion.h"
#include "engine/scene/procedural.h"
#include "ui/cli/number_range.h"

#include <array>
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

constexpr std::array<std::pair<const char*, scene::Instancing>, 3> INSTANCING = {
    {{"auto", scene::Instancing::Auto}, {"on", scene::Instancing::On}, {"off", scene::Instancing::Off}}};

std::optional<scene::Instancing> instancingOf(const std::string& word)
{
    for (const auto& [name, value] : INSTANCING)
        if (word == name) return value;
    return {};
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
    return scene::loadGltf(source.name, {.progress = progress,
                                         .sky = sky,
                                         .animations = source.animation != "off",
                                         .instancing = source.instancing,
                                         .assetRoot = source.assetRoot});
}

void animate(scene::Scene& scene, const SceneSource& source)
{
    if (source.atRest()) return;
    const std::vector<uint32_t> chosen = chosenAnimations(scene, source);
    if (chosen.empty() && source.animation != "off")
        scene.warnings.push_back("The scene has no animation: it is the same at every --time.");
    if (chosen.empty()) return;
    if (scene::contested(*scene.motion, chosen))
        scene.warnings.push_back("Several animations move the same things, and the first of them does: choose another "
                                 "with --animation NAME.");
    scene::pose(scene, chosen, source.time.value_or(0));
}

} // namespace

std::vector<uint32_t> chosenAnimations(const scene::Scene& scene, const SceneSource& source)
{
    return scene::chooseAnimations(scene, source.animation.empty() ? "all" : source.animation);
}

std::vector<std::pair<std::string, std::string>> SceneSource::toText() const
{
    std::vector<std::pair<std::string, std::string>> text;
    if (instancing != scene::Instancing::Auto)
        for (const auto& [word, value] : INSTANCING)
            if (instancing == value) text.emplace_back("instances", word);
    if (time) text.emplace_back("time", fmt::format("{}", *time));
    if (!animation.empty()) text.emplace_back("animation", animation);
    return text;
}

CLI::Option* addSceneOptions(CLI::App& app, SceneSource& source, const std::string& doc)
{
    app.add_option(
           "--asset-root", source.assetRoot,
           "The scene's buffers and textures may lie anywhere below this directory, as in \"../textures/x.png\"; "
           "without it, only below the scene's own folder. Others are refused, and links that lead to others.")
        ->option_text("DIR");
    app.add_option_function<std::string>(
           "--instances", [&source](const std::string& word) { source.instancing = instancingOf(word).value(); },
           "Meshes that stand in several places (shared meshes, EXT_mesh_gpu_instancing) are stored once, with a tree "
           "of their own: where copies would be more than a million triangles (auto), wherever they keep their shape, "
           "do not emit and rest (on), or never (off). Less memory, slower rays, the same light.")
        ->option_text("auto|on|off (auto)")
        ->check([](const std::string& word) {
            return instancingOf(word) ? std::string() : fmt::format("\"{}\" is none of auto, on and off.", word);
        });
    app.add_option("--time", source.time,
                   "Shows an animated scene as it is at this time, held still (or as it plays on from there: --fps); "
                   "before the first "
                   "key and after the last it rests there. Without it, and without --animation, the scene is in the "
                   "pose that its nodes state.")
        ->option_text("0 to 1e6 s (at rest)")
        ->check(within(0.0, 1e6))
        ->group("Animation");
    app.add_option(
           "--animation", source.animation,
           "Which animations --time (0 s, where it is not given) plays; info SCENE lists them. Where several move "
           "the same thing, the first does. off: they are not read at all, whatever is wrong with them.")
        ->option_text("NAME|INDEX|all|off (all)")
        ->group("Animation");
    return app.add_option("SCENE", source.name, doc);
}

scene::Scene openScene(const SceneSource& source, const passes::Settings& settings, const LoadProgress& progress)
{
    scene::Scene scene = load(source, settings.environment.empty(), progress);
    animate(scene, source);
    scene::setEnvironment(scene, settings.environment, settings.environmentScale);
    return scene;
}

scene::Scene openScene(const SceneSource& source, const passes::Settings& settings, Progress& progress)
{
    scene::Scene scene = openScene(source, settings,
                                   [&](const std::string& what, double fraction) { progress.show(what, fraction, 1); });
    progress.clear();
    if (const size_t count = scene.motion ? scene.motion->animations.size() : 0; count > 0 && source.atRest())
        scene.warnings.push_back(fmt::format(
            "The scene has {} animation{} and is shown at rest: --time SECONDS shows it as it is at that time.", count,
            count == 1 ? "" : "s"));
    for (const std::string& warning : scene.warnings) std::fprintf(stderr, "Warning: %s\n", warning.c_str());
    return scene;
}

} // namespace ui
