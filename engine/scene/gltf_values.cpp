#include "engine/scene/gltf_values.h"

#include <algorithm>
#include <cmath>

namespace scene::gltf
{

const tinygltf::Value* findExtension(const tinygltf::ExtensionMap& extensions, const char* name)
{
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

glm::dvec3 unitOrZero(const glm::dvec3& v)
{
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : glm::dvec3(0);
}

double clamped(double value, double minimum, double maximum, const std::string& what, Warnings& warnings)
{
    const double result = std::clamp(value, minimum, maximum);
    if (result != value) warnings.add(fmt::format("Clamped {} from {} to {}.", what, value, result));
    return result;
}

} // namespace scene::gltf
