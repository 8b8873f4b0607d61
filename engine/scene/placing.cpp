#include "engine/scene/placing.h"

#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

namespace scene
{

namespace
{

bool isPlaced(const glm::dvec3& position)
{
    constexpr double FARTHEST = 1e12; // metres; its square is far inside float32
    return glm::all(glm::lessThan(glm::abs(position), glm::dvec3(FARTHEST))); // not where one is NaN
}

} // namespace

glm::dvec3 unitOrZero(const glm::dvec3& v)
{
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : glm::dvec3(0);
}

glm::dmat4 Transform::toMatrix() const
{
    if (matrix) return *matrix;
    return glm::scale(glm::translate(glm::dmat4(1), translation) * glm::mat4_cast(rotation), scale);
}

bool placeCamera(Camera& camera, const glm::dmat4& worldFromNode)
{
    const glm::dvec3 forward = unitOrZero(-glm::dvec3(worldFromNode[2]));
    const glm::dvec3 right = unitOrZero(glm::cross(forward, glm::dvec3(worldFromNode[1])));
    if (right == glm::dvec3(0) || !isPlaced(glm::dvec3(worldFromNode[3]))) return false;
    camera.position = glm::dvec3(worldFromNode[3]);
    camera.forward = forward;
    camera.right = right;
    camera.up = glm::cross(right, forward);
    return true;
}

void aim(Camera& camera, double radius)
{
    const double ahead = glm::dot(-camera.position, camera.forward);
    camera.target = camera.position + camera.forward * (ahead > 0.01 * radius ? ahead : 0.5 * radius);
}

std::optional<glm::dvec3> placeLight(PunctualLight& light, const glm::dmat4& worldFromNode)
{
    const glm::dvec3 along = unitOrZero(-glm::dvec3(worldFromNode[2])), position(worldFromNode[3]);
    if ((light.kind != LightKind::Point && along == glm::dvec3(0)) || !isPlaced(position)) return std::nullopt;
    if (light.kind != LightKind::Point) light.direction = glm::vec3(along);
    return position;
}

void shine(PunctualLight& light, const Lamp& lamp, const Clamp& clamp)
{
    for (int c = 0; c < 3; ++c)
        light.intensity[c] =
            static_cast<float>(clamp(lamp.color[c] * lamp.intensity, 0, MAX_RADIANCE, "the intensity of a light"));
    if (light.kind != LightKind::Spot) return;
    // Radians, of which directions in float32 resolve 1e-7. The falloff divides by the edge's width.
    constexpr double NARROWEST = 1e-5, WIDEST_INNER = 1 - 1e-4;
    const double outer = clamp(lamp.outerConeAngle, NARROWEST, std::numbers::pi / 2, "the outer cone of a spot light");
    const double inner = clamp(lamp.innerConeAngle, 0, outer * WIDEST_INNER, "the inner cone of a spot light");
    light.outerConeAngle = static_cast<float>(outer);
    light.innerConeAngle = static_cast<float>(inner);
}

} // namespace scene
