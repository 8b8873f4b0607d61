#include "engine/scene/gltf_values.h"

#include <algorithm>

namespace scene::gltf
{

const tinygltf::Value* findExtension(const tinygltf::ExtensionMap& extensions, const char* name)
{
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

double clamped(double value, double minimum, double maximum, const std::string& what, Warnings& warnings)
{
    const double result = std::clamp(value, minimum, maximum);
    if (result != value) warnings.add(fmt::format("Clamped {} from {} to {}.", what, value, result));
    return result;
}

} // namespace scene::gltf
