#pragma once
// Extensions of what tinygltf has read, directions, and ranges of numbers.

#include <optional>
#include <string>

#include <glm/glm.hpp>

#include "engine/scene/gltf_document.h"

namespace scene::gltf
{

// Brighter is refused: products of light, surface and distance must stay far inside float32.
constexpr double MAX_RADIANCE = 1e12;

const tinygltf::Value* findExtension(const tinygltf::ExtensionMap& extensions, const char* name);

glm::dvec3 unitOrZero(const glm::dvec3& v); // zero where it has no direction

// The nearest value in the range, with a warning when that is another: "Clamped the roughness of a material ...".
double clamped(double value, double minimum, double maximum, const std::string& what, Warnings& warnings);

} // namespace scene::gltf
