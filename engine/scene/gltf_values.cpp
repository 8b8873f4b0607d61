#include "engine/scene/gltf_values.h"

#include <algorithm>

namespace scene::gltf
{

const tinygltf::Value* findExtension(const tinygltf::ExtensionMap& extensions, const char* name)
{
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

double numberOf(const tinygltf::Value& object, const char* key, double absent)
{
    return object.Has(key) ? object.Get(key).GetNumberAsDouble() : absent;
}

glm::dvec3 vec3Of(const tinygltf::Value& object, const char* key, const glm::dvec3& absent)
{
    if (!object.Has(key)) return absent;
    const tinygltf::Value& array = object.Get(key);
    return {array.Get(0).GetNumberAsDouble(), array.Get(1).GetNumberAsDouble(), array.Get(2).GetNumberAsDouble()};
}

double clamped(double value, double minimum, double maximum, const std::string& what, Warnings& warnings)
{
    const double result = std::clamp(value, minimum, maximum);
    if (result != value) warnings.add(fmt::format("Clamped {} from {} to {}.", what, value, result));
    return result;
}

} // namespace scene::gltf
