#include "ui/window/pose.h"

#include "passes/camera_path.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>

namespace ui
{

namespace
{

constexpr double MAX_PITCH = glm::half_pi<double>() - 0.02;

struct Axes {
    glm::dvec3 right, up, forward;
};
Axes axesOf(const Pose& pose)
{
    const glm::dvec3 forward = glm::normalize(pose.target - pose.position);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, pose.up));
    return {right, glm::cross(right, forward), forward};
}

// `direction` turned about the vertical by `yaw` and up by `pitch`, its length kept.
glm::dvec3 turned(const glm::dvec3& direction, double yaw, double pitch)
{
    const double length = glm::length(direction);
    const double azimuth = std::atan2(direction.x, direction.z) + yaw;
    const double height =
        std::clamp(std::asin(std::clamp(direction.y / length, -1.0, 1.0)) + pitch, -MAX_PITCH, MAX_PITCH);
    return length *
           glm::dvec3(std::cos(height) * std::sin(azimuth), std::sin(height), std::cos(height) * std::cos(azimuth));
}

} // namespace

Pose poseOf(const scene::Camera& camera, const glm::dvec3& sceneOrigin)
{
    Pose pose = viewOf(camera, sceneOrigin);
    if (std::abs(camera.forward.y) < std::sin(MAX_PITCH)) pose.up = {0, 1, 0};
    return pose;
}

Pose viewOf(const scene::Camera& camera, const glm::dvec3& sceneOrigin)
{
    const double distance = glm::length(camera.target - camera.position);
    const glm::dvec3 position = camera.position + sceneOrigin;
    return {.position = position,
            .target = position + camera.forward * (distance > 0 ? distance : 1),
            .up = camera.up,
            .yfov = camera.orthographic ? 45 : glm::degrees(camera.yfov)};
}

nlohmann::ordered_json toJson(const Pose& pose)
{
    const auto list = [](const glm::dvec3& v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
    return {{"frame", 0u},
            {"position", list(pose.position)},
            {"target", list(pose.target)},
            {"up", list(pose.up)},
            {"yfov", pose.yfov}};
}

nlohmann::ordered_json toCameraPath(const Pose& pose)
{
    return {{"keyframes", {toJson(pose)}}};
}

scene::Camera cameraOf(const Pose& pose, const scene::Camera& base, const glm::dvec3& sceneOrigin)
{
    return passes::cameraPath(toCameraPath(pose), base, sceneOrigin)(0);
}

void orbit(Pose& pose, double yaw, double pitch)
{
    pose.up = {0, 1, 0};
    pose.position = pose.target + turned(pose.position - pose.target, yaw, pitch);
}

void look(Pose& pose, double yaw, double pitch)
{
    pose.up = {0, 1, 0};
    pose.target = pose.position + turned(pose.target - pose.position, yaw, pitch);
}

void pan(Pose& pose, double right, double up)
{
    const Axes axes = axesOf(pose);
    const double height = 2 * glm::length(pose.target - pose.position) * std::tan(glm::radians(pose.yfov) / 2);
    const glm::dvec3 step = height * (right * axes.right + up * axes.up);
    pose.position += step;
    pose.target += step;
}

void dolly(Pose& pose, double factor)
{
    pose.position = pose.target + factor * (pose.position - pose.target);
}

void fly(Pose& pose, const glm::dvec3& step)
{
    const Axes axes = axesOf(pose);
    const glm::dvec3 move = step.x * axes.right + step.y * axes.up + step.z * axes.forward;
    pose.position += move;
    pose.target += move;
}

} // namespace ui
