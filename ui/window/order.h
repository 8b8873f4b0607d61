#pragma once
// What the window asks of the render thread, and what comes back.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/gpu/gpu.h"
#include "engine/image/image.h"
#include "passes/inspector.h"
#include "ui/cli/motion_options.h"
#include "ui/cli/scene_source.h"
#include "ui/window/camera_keys.h"
#include "ui/window/pose.h"

namespace ui
{

// The two settings that are compared. Alone, there is A.
enum Side : int { A, B, SIDES };

// What pictures come with.
struct Inspect {
    bool reservoirs = false;                      // what they hold
    bool shifts = false;                          // how spatial shifts ended
    std::optional<std::array<uint32_t, 2>> pixel; // of the full size: the paths that its reservoirs hold
    bool operator==(const Inspect&) const = default;
};

// What is measured beside the pictures (studies.h).
struct StudyOrder {
    bool reference = false;   // a path traced reference that converges
    bool correlation = false; // the autocovariance of successive frames
    bool floor = false;       // color noise that no history removes
    uint64_t savings = 0;     // how often "what does leaving out save" was asked
    bool operator==(const StudyOrder&) const = default;
};

// What the window wants to see.
struct Order {
    SceneSource scene;         // its name is empty: nothing yet. At its time the scene rests or begins to play
    passes::Settings settings; // of A
    std::optional<passes::Settings> rival; // of B; what says which picture (size, camera, environment) is A's
    std::optional<Pose> pose;              // empty: the camera that the settings name
    CameraKeys path;                       // that the camera follows while it plays, where there is no `pose`
    bool moving = false;                   // the camera: single frames at a part of the resolution, no film
    bool playing = false;                  // scene and path: single frames, each of its own time, no film
    Play play = {.fps = 30};
    uint64_t frame = 0;  // of the timeline, at which it rests or begins to play
    uint64_t plays = 0;  // how often it has begun to play
    bool paused = false; // no frames at all
    Inspect inspect;
    StudyOrder studies;
    uint64_t restarts = 0; // how often "from the first frame again" was asked for
    uint64_t steps = 0;    // how many single frames were asked for while paused
    bool operator==(const Order&) const = default;
};

bool followsPath(const Order& order);

// As they are to run: with A's world, and with a part of the resolution while the camera moves.
passes::Settings settingsOf(const Order& order, Side side);

struct AnimationFacts {
    std::string name, fault; // why it cannot be played; empty: it can
    double seconds = 0;      // how long it is
};

// What a scene offers to the window.
struct SceneFacts {
    std::string name; // as ordered
    std::vector<AnimationFacts> animations;
    glm::dvec3 origin = {0, 0, 0};
    std::vector<std::string> warnings;
};

// One finished picture and how it came about.
struct Shot {
    image::Image picture;
    Order order;          // its `settings` are those of this picture, whichever side; the size is that of the picture
    scene::Camera camera; // that sees it, in the scene's coordinates
    std::optional<double> sceneSeconds; // that it shows; none: the scene at rest
    std::optional<double> firstSeconds; // that the first frame of its film has shown
    uint64_t firstFrame = 0;            // of the timeline, which that was
    uint64_t run = 0;                   // grows whenever a film starts
    uint64_t frames = 0;
    double seconds = 0;  // of rendering, since the film started
    bool single = false; // the last frame alone, not the mean
    passes::RenderStats stats;
    gpu::Adapter adapter;
    double frameMilliseconds = 0; // wall, from frame to frame
    double raysPerSecond = 0;
    // As passes::Inspector reads them; empty: not asked for, or none there.
    std::vector<shared::Inspection> reservoirs;
    std::vector<passes::ShiftCounts> shifts;
    std::vector<std::vector<shared::PathPoint>> paths;
};
using ShotPointer = std::shared_ptr<const Shot>;

// What decides the pixels of a shot besides settings and camera, as metadata and as options of `render`: the pose.
std::vector<std::pair<std::string, std::string>> poseText(const Shot& shot);

} // namespace ui
