#include "engine/scene/open_scene.h"

#include <algorithm>
#include <cctype>

#include "engine/base/error.h"
#include "engine/scene/environment.h"
#include "engine/scene/procedural.h"

namespace scene
{

namespace
{

bool isGltfName(const std::string& name)
{
    std::string extension = std::filesystem::path(name).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension == ".gltf" || extension == ".glb";
}

Scene makeOrLoad(const std::string& nameOrFile, const OpenOptions& options)
{
    std::string names;
    for (const BuiltInScene& builtIn : builtInScenes()) {
        if (nameOrFile == builtIn.name) return builtIn.make();
        names += (names.empty() ? "" : ", ") + std::string(builtIn.name);
    }
    if (!isGltfName(nameOrFile))
        throw Error("\"{}\" is neither a built-in scene ({}) nor a .gltf or .glb file.", nameOrFile, names);
    return loadGltf(nameOrFile, {.progress = options.progress, .sky = options.environment.empty()});
}

} // namespace

Scene openScene(const std::string& nameOrFile, const OpenOptions& options)
{
    Scene scene = makeOrLoad(nameOrFile, options);
    setEnvironment(scene, options.environment, options.environmentScale);
    return scene;
}

} // namespace scene
