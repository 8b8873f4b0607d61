#include "ui/window/camera_keys.h"

#include "engine/base/files.h"
#include "engine/base/json.h"
#include "passes/camera_path.h"

#include <utility>

#include <nlohmann/json.hpp>

namespace ui
{

namespace
{

using Json = nlohmann::ordered_json;

int64_t frameOf(const Json& key)
{
    return key["frame"].get<int64_t>();
}

// The keyframes but one, and in its place another, unless that is null.
CameraKeys replaced(const CameraKeys& keys, int64_t frame, const Json& key)
{
    Json list = Json::array();
    bool waits = !key.is_null();
    if (keys)
        for (const Json& old : (*keys)["keyframes"]) {
            if (waits && frameOf(old) >= frame) list.push_back(key), waits = false;
            if (frameOf(old) != frame) list.push_back(old);
        }
    if (waits) list.push_back(key);
    if (list.empty()) return nullptr;
    auto path = std::make_shared<const Json>(Json{{"keyframes", std::move(list)}});
    passes::cameraPath(*path, {}, {0, 0, 0});
    return path;
}

} // namespace

CameraKeys loadKeys(const std::string& file)
{
    passes::loadCameraPath(file, {}, {0, 0, 0});
    return std::make_shared<const Json>(parseJson(files::read(file)));
}

std::vector<int64_t> framesOf(const CameraKeys& keys)
{
    std::vector<int64_t> frames;
    if (keys)
        for (const Json& key : (*keys)["keyframes"]) frames.push_back(frameOf(key));
    return frames;
}

CameraKeys withKey(const CameraKeys& keys, uint64_t frame, const Pose& pose)
{
    Json key = toJson(pose);
    key["frame"] = frame;
    return replaced(keys, int64_t(frame), key);
}

CameraKeys withoutKey(const CameraKeys& keys, int64_t frame)
{
    return replaced(keys, frame, nullptr);
}

Json pathFrom(const CameraKeys& keys, uint64_t frame)
{
    Json path = *keys;
    for (Json& key : path["keyframes"]) key["frame"] = frameOf(key) - int64_t(frame);
    return path;
}

Pose poseAt(const CameraKeys& keys, const scene::Camera& base, uint64_t frame)
{
    return viewOf(passes::cameraPath(*keys, base, {0, 0, 0})(frame), {0, 0, 0});
}

} // namespace ui
