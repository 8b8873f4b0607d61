#pragma once
// The random numbers by which a surface's lobes draw a direction, in float64: the inverse of the shader's sampling,
// from which densities follow by numeric differentiation. Shares neither code nor formulas for densities with the
// shaders.

#include <functional>
#include <optional>

#include <glm/glm.hpp>

#include "tests/shaders/path/shifts.h"

namespace support
{

enum class Lobe { Diffuse, Reflection, Transmission };
constexpr Lobe LOBES[] = {Lobe::Diffuse, Lobe::Reflection, Lobe::Transmission};

// The pair of numbers in [0, 1)^2 for which the lobe scatters in `direction` (unit, world); none when it never does.
std::optional<glm::dvec2> numbersOf(const shared::Scattering& at, Lobe lobe, const glm::dvec3& direction);

// All three numbers, of the lobe that draws the direction most often.
std::optional<glm::dvec3> numbersOf(const shared::Scattering& at, const glm::dvec3& direction);

// A surface patch of directions, by two coordinates around (0, 0).
using Patch = std::function<glm::dvec3(const glm::dvec2&)>;

// How much of the random numbers' cube draws a direction of the patch, over the area of its coordinates: the sum over
// the lobes of |d numbers / d coordinates|, by central differences at (0, 0).
double densityOver(const shared::Scattering& at, const Patch& patch);

} // namespace support
