#include "passes/camera_path.h"

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/base/json.h"
#include "engine/base/shown.h"
#include "engine/scene/choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>

namespace passes
{

namespace
{

using Json = nlohmann::ordered_json;

constexpr uint64_t MAX_FILE_BYTES = uint64_t{64} << 20;
constexpr double MAX_COORDINATE = 1e12; // of the same order as what scenes may have
constexpr double MIN_SINE = 1e-6;       // between up and the view direction

// All that is interpolated. The field is kept as log tan(yfov/2): whatever a cubic makes of it is a valid angle.
struct Pose {
    glm::dvec3 position, target, up;
    double field;
};
Pose operator*(double s, const Pose& p)
{
    return {s * p.position, s * p.target, s * p.up, s * p.field};
}
Pose operator+(const Pose& a, const Pose& b)
{
    return {a.position + b.position, a.target + b.target, a.up + b.up, a.field + b.field};
}

struct Keyframe {
    double frame;
    Pose pose;
};

glm::dvec3 vectorOf(const Json& json, const char* name)
{
    const auto isCoordinate = [](const Json& value) {
        return value.is_number() && std::abs(value.get<double>()) <= MAX_COORDINATE;
    };
    if (!json.is_array() || json.size() != 3 || !std::ranges::all_of(json, isCoordinate))
        throw Error("\"{}\" must be three numbers of at most {:g}, not {}.", name, MAX_COORDINATE,
                    shown(jsonText(json)));
    return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

Keyframe keyframeOf(const Json& json, const scene::Camera& base, const glm::dvec3& origin)
{
    if (!json.is_object()) throw Error("A keyframe is an object, not {}.", shown(jsonText(json)));
    static const std::set<std::string> KNOWN = {"frame", "position", "target", "up", "yfov"};
    for (const auto& [name, value] : json.items())
        if (!KNOWN.contains(name)) throw Error("There is no \"{}\" in a keyframe.", shown(name));
    for (const char* name : {"frame", "position", "target"})
        if (!json.contains(name)) throw Error("\"{}\" is missing.", name);

    const Json& frame = json["frame"];
    if (!frame.is_number_integer() || std::abs(frame.get<double>()) > MAX_KEYFRAME)
        throw Error("\"frame\" must be a whole number from -{0} to {0}, not {1}.", MAX_KEYFRAME,
                    shown(jsonText(frame)));
    double yfov = base.orthographic ? glm::half_pi<double>() : base.yfov;
    if (json.contains("yfov")) {
        const Json& degrees = json["yfov"];
        if (!degrees.is_number() || !(degrees.get<double>() > 0.01 && degrees.get<double>() < 179))
            throw Error("\"yfov\" must be an angle between 0.01 and 179 degrees, not {}.", shown(jsonText(degrees)));
        yfov = glm::radians(degrees.get<double>());
    }
    return {.frame = frame.get<double>(),
            .pose = {.position = vectorOf(json["position"], "position") - origin,
                     .target = vectorOf(json["target"], "target") - origin,
                     .up = json.contains("up") ? vectorOf(json["up"], "up") : glm::dvec3(0, 1, 0),
                     .field = std::log(std::tan(yfov / 2))}};
}

std::vector<Keyframe> keyframesOf(const Json& path, const scene::Camera& base, const glm::dvec3& origin)
{
    if (!path.is_object() || path.size() != 1 || !path.contains("keyframes") || !path["keyframes"].is_array() ||
        path["keyframes"].empty())
        throw Error("A camera path is an object {{\"keyframes\": [...]}} with at least one keyframe and nothing else.");
    std::vector<Keyframe> keyframes;
    for (const Json& json : path["keyframes"]) {
        whileDoing(fmt::format("reading keyframe {} (counted from 0)", keyframes.size()), [&] {
            const Keyframe next = keyframeOf(json, base, origin);
            if (!keyframes.empty() && next.frame <= keyframes.back().frame)
                throw Error("Frame {} does not come after the keyframe before it, {}.", next.frame,
                            keyframes.back().frame);
            keyframes.push_back(next);
        });
    }
    return keyframes;
}

// Change per frame at a keyframe: of the parabola through it and its neighbors; at the ends, of the straight line.
Pose slopeAt(const std::vector<Keyframe>& keys, size_t i)
{
    const auto between = [&](size_t a) {
        return 1 / (keys[a + 1].frame - keys[a].frame) * (keys[a + 1].pose + -1.0 * keys[a].pose);
    };
    if (i == 0) return between(0);
    if (i + 1 == keys.size()) return between(i - 1);
    const double before = keys[i].frame - keys[i - 1].frame, after = keys[i + 1].frame - keys[i].frame;
    return after / (before + after) * between(i - 1) + before / (before + after) * between(i);
}

// Cubic Hermite.
Pose poseAt(const std::vector<Keyframe>& keys, double frame)
{
    if (frame <= keys.front().frame) return keys.front().pose;
    if (frame >= keys.back().frame) return keys.back().pose;
    const auto above = std::ranges::upper_bound(keys, frame, {}, &Keyframe::frame);
    const size_t i = size_t(above - keys.begin()) - 1;
    const double length = keys[i + 1].frame - keys[i].frame;
    const double t = (frame - keys[i].frame) / length, t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * keys[i].pose + (t3 - 2 * t2 + t) * length * slopeAt(keys, i) +
           (3 * t2 - 2 * t3) * keys[i + 1].pose + (t3 - t2) * length * slopeAt(keys, i + 1);
}

scene::Camera cameraOf(const scene::Camera& base, const Pose& pose, uint64_t frame)
{
    const glm::dvec3 view = pose.target - pose.position;
    if (!(glm::length(view) > 0)) throw Error("At frame {} the camera stands at the point that it looks at.", frame);
    const glm::dvec3 forward = glm::normalize(view);
    const glm::dvec3 sideways = glm::cross(forward, pose.up);
    if (!(glm::length(sideways) > MIN_SINE * glm::length(pose.up)))
        throw Error("At frame {} the camera looks along its up vector.", frame);

    scene::Camera camera = base;
    camera.position = pose.position;
    camera.target = pose.target;
    camera.forward = forward;
    camera.right = glm::normalize(sideways);
    camera.up = glm::cross(camera.right, forward);
    if (!base.orthographic) camera.yfov = 2 * std::atan(std::exp(pose.field));
    return camera;
}

} // namespace

uint32_t chooseCamera(const scene::Scene& scene, const std::string& nameOrIndex)
{
    CHECK(!scene.cameras.empty());
    if (nameOrIndex.empty()) return 0;
    std::vector<std::string> names;
    for (const scene::Camera& camera : scene.cameras) names.push_back(camera.name);
    return scene::chooseName(names, nameOrIndex, "camera");
}

CameraAt cameraPath(const Json& path, const scene::Camera& base, const glm::dvec3& sceneOrigin)
{
    const std::vector<Keyframe> keyframes = keyframesOf(path, base, sceneOrigin);
    CameraAt cameraAt = [base, keyframes](uint64_t frame) {
        return cameraOf(base, poseAt(keyframes, double(frame)), frame);
    };
    // Every camera is made once now: errors come before the work, not in the middle of it.
    const double last = std::max(keyframes.back().frame, 0.0);
    for (double frame = std::max(keyframes.front().frame, 0.0); frame <= last; ++frame) cameraAt(uint64_t(frame));
    return cameraAt;
}

namespace
{

template <class Use>
auto withFile(const std::filesystem::path& file, Use&& use)
{
    const std::vector<std::byte> bytes = files::read(file, MAX_FILE_BYTES);
    return whileDoing(fmt::format("reading camera path \"{}\"", file.string()), [&] { return use(parseJson(bytes)); });
}

} // namespace

CameraAt loadCameraPath(const std::filesystem::path& file, const scene::Camera& base, const glm::dvec3& sceneOrigin)
{
    return withFile(file, [&](const Json& path) { return cameraPath(path, base, sceneOrigin); });
}

bool standsStill(const std::filesystem::path& file)
{
    return withFile(file, [](const Json& path) {
        return path.is_object() && path.contains("keyframes") && path["keyframes"].size() == 1;
    });
}

CameraAt cameraOrbit(const scene::Camera& base, double degreesPerFrame)
{
    return [base, degreesPerFrame](uint64_t frame) {
        const double angle = glm::radians(std::remainder(degreesPerFrame * double(frame), 360.0));
        const double c = std::cos(angle), s = std::sin(angle);
        const auto turned = [&](const glm::dvec3& v) { return glm::dvec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x); };
        scene::Camera camera = base;
        camera.position = base.target + turned(base.position - base.target);
        camera.right = turned(base.right);
        camera.up = turned(base.up);
        camera.forward = turned(base.forward);
        return camera;
    };
}

} // namespace passes
