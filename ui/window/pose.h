#pragma once
// Where the window's camera is, and how hands move it. Said as one keyframe of a camera path, so that `render
// --camera-path` sees exactly the same.

#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>

#include "engine/scene/scene.h"

namespace ui
{

// In the scene file's own (world) coordinates.
struct Pose {
    glm::dvec3 position = {0, 0, 1};
    glm::dvec3 target = {0, 0, 0}; // what an orbit turns around
    glm::dvec3 up = {0, 1, 0};
    double yfov = 45; // degrees
    bool operator==(const Pose&) const = default;
};

Pose poseOf(const scene::Camera& camera, const glm::dvec3& sceneOrigin); // upright, as hands turn it
Pose viewOf(const scene::Camera& camera, const glm::dvec3& sceneOrigin); // with the tilt that it has

// As a keyframe at frame 0, and as a path: {"keyframes": [this one]}.
nlohmann::ordered_json toJson(const Pose& pose);
nlohmann::ordered_json toCameraPath(const Pose& pose);

// The camera that `--camera-path` makes of it, bit by bit.
scene::Camera cameraOf(const Pose& pose, const scene::Camera& base, const glm::dvec3& sceneOrigin);

// Angles in radians. Pitch stops short of straight up and down.
void orbit(Pose& pose, double yaw, double pitch); // about the target
void look(Pose& pose, double yaw, double pitch);  // about the camera
void pan(Pose& pose, double right, double up);    // in heights of the picture at the target's distance
void dolly(Pose& pose, double factor);            // distance to the target times `factor`
void fly(Pose& pose, const glm::dvec3& step);     // right, up and forward, in world units

} // namespace ui
