#pragma once
// The camera that a render starts from, and its motion without a window: along keyframes from a file, or around the
// point that the camera looks at.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "engine/scene/scene.h"

namespace passes
{

// Which camera `--camera NAME|INDEX` means: the first of that name, else that of that index; empty: the first. Throws
// Error that lists the cameras.
uint32_t chooseCamera(const scene::Scene& scene, const std::string& nameOrIndex);

// The camera of a frame, counted from 0.
using CameraAt = std::function<scene::Camera(uint64_t frame)>;

constexpr uint32_t MAX_KEYFRAME = 1000000; // the largest frame of a keyframe, and its negative the smallest

// {"keyframes": [{"frame": 0, "position": [x, y, z], "target": [x, y, z], "up": [0, 1, 0], "yfov": degrees}, ...]}
// Positions are the scene file's own (world) coordinates; up and yfov may be left out: +y, and that of `base`. Between
// keyframes position, target and up follow a cubic through them that never stops with a jerk; before the first and
// after the last one the camera stands still. Frames below 0 are of a way that began before the first picture. An
// orthographic `base` ignores yfov. Throws Error naming the keyframe: anything else in the object, frames that do not
// increase, a camera without a direction at any frame.
CameraAt cameraPath(const nlohmann::ordered_json& path, const scene::Camera& base, const glm::dvec3& sceneOrigin);
// Whether a file has one keyframe only, and so a camera that never moves. Throws Error: not readable, no JSON.
bool standsStill(const std::filesystem::path& file);
CameraAt loadCameraPath(const std::filesystem::path& file, const scene::Camera& base, const glm::dvec3& sceneOrigin);

// Turns `base` about the vertical (+y) through its target (scene::Camera::target), counter-clockwise seen from above.
CameraAt cameraOrbit(const scene::Camera& base, double degreesPerFrame);

} // namespace passes
