#pragma once
// Extensions of what tinygltf has read, and ranges of numbers.

#include <optional>
#include <string>

#include <glm/glm.hpp>

#include "engine/scene/gltf_document.h"
#include "engine/scene/placing.h"

namespace scene::gltf
{

const tinygltf::Value* findExtension(const tinygltf::ExtensionMap& extensions, const char* name);

// The nearest value in the range, with a warning when that is another: "Clamped the roughness of a material ...".
double clamped(double value, double minimum, double maximum, const std::string& what, Warnings& warnings);

} // namespace scene::gltf
