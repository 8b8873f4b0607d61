#pragma once
// Transforms of nodes, and what cameras and lights make of where they stand (glTF 2.0, 3.5.3 and 3.10.2;
// KHR_lights_punctual). Loading and posing share it.

#include <functional>
#include <optional>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "engine/scene/scene.h"

namespace scene
{

glm::dvec3 unitOrZero(const glm::dvec3& v); // zero where it has no direction

// Brighter is refused: products of light, surface and distance must stay far inside float32.
constexpr double MAX_RADIANCE = 1e12;

// parent from node: translation * rotation * scale, or a matrix, which no animation can move.
struct Transform {
    glm::dvec3 translation = {0, 0, 0};
    glm::dquat rotation = {1, 0, 0, 0}; // w, x, y, z; unit
    glm::dvec3 scale = {1, 1, 1};
    std::optional<glm::dmat4> matrix;

    glm::dmat4 toMatrix() const;
};

// A camera looks along -z with +y up; scale and mirroring do not reach the picture. Its position is the world's. False,
// and nothing is changed: the transform has no direction or place.
bool placeCamera(Camera& camera, const glm::dmat4& worldFromNode);

// Sets what it looks at: the point of its view axis that is nearest to the origin, in a scene of that radius around it.
void aim(Camera& camera, double radius);

// A light shines along -z. Its position in the world is returned, its own is not set; nothing: as above.
std::optional<glm::dvec3> placeLight(PunctualLight& light, const glm::dmat4& worldFromNode);

// What a light gives, as files say it.
struct Lamp {
    glm::dvec3 color = {1, 1, 1};
    double intensity = 1;      // W/sr (point, spot), W/m^2 (directional)
    double innerConeAngle = 0; // radians
    double outerConeAngle = 0.785398163397448;
};

// The nearest value in a range; `what` is what the value is: "the intensity of a light".
using Clamp = std::function<double(double value, double minimum, double maximum, const char* what)>;

void shine(PunctualLight& light, const Lamp& lamp, const Clamp& clamp);

} // namespace scene
