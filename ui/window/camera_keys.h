#pragma once
// A camera path, made keyframe by keyframe: always one that `render --camera-path` reads.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "ui/window/pose.h"

namespace ui
{

// {"keyframes": [...]}, as passes::cameraPath() has it; never changed, but replaced. Null: there is none.
using CameraKeys = std::shared_ptr<const nlohmann::ordered_json>;

CameraKeys loadKeys(const std::string& file); // throws Error: no camera path

std::vector<int64_t> framesOf(const CameraKeys& keys); // in their order; of null: none

// Another path with a keyframe there, in the place of one that was. Throws Error: at some frame the camera would look
// nowhere.
CameraKeys withKey(const CameraKeys& keys, uint64_t frame, const Pose& pose);
CameraKeys withoutKey(const CameraKeys& keys, int64_t frame); // likewise; without its last one: null

// The rest of the way from a frame on, which becomes frame 0.
nlohmann::ordered_json pathFrom(const CameraKeys& keys, uint64_t frame);

// What it sees at a frame. `base`: what decides where keyframes are silent.
Pose poseAt(const CameraKeys& keys, const scene::Camera& base, uint64_t frame);

} // namespace ui
