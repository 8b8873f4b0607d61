#include "passes/camera_choice.h"

#include "engine/base/check.h"
#include "engine/base/error.h"

#include <charconv>

namespace passes
{

uint32_t chooseCamera(const scene::Scene& scene, const std::string& nameOrIndex)
{
    CHECK(!scene.cameras.empty());
    if (nameOrIndex.empty()) return 0;
    for (uint32_t i = 0; i < scene.cameras.size(); ++i)
        if (scene.cameras[i].name == nameOrIndex) return i;

    uint32_t index = 0;
    const char* textEnd = nameOrIndex.data() + nameOrIndex.size();
    const auto [end, error] = std::from_chars(nameOrIndex.data(), textEnd, index);
    if (error == std::errc{} && end == textEnd && index < scene.cameras.size()) return index;

    std::string names;
    for (size_t i = 0; i < scene.cameras.size(); ++i)
        names += fmt::format("{}{} \"{}\"", i == 0 ? "" : ", ", i, scene.cameras[i].name);
    throw Error("Scene \"{}\" has no camera \"{}\"; it has: {}.", scene.name, nameOrIndex, names);
}

} // namespace passes
