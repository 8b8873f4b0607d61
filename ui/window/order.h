#pragma once
// What the window asks of the render thread, and what comes back.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/gpu/gpu.h"
#include "engine/image/image.h"
#include "passes/renderer.h"
#include "shaders/shared/inspection.h"
#include "ui/window/pose.h"

namespace ui
{

// The two settings that are compared. Alone, there is A.
enum Side : int { A, B, SIDES };

// What the window wants to see.
struct Order {
    std::string scene;                     // empty: nothing yet
    passes::Settings settings;             // of A
    std::optional<passes::Settings> rival; // of B; what says which picture (size, camera, environment) is A's
    std::optional<Pose> pose;              // empty: the camera that the settings name
    bool moving = false;                   // the camera: single frames at a part of the resolution, no film
    bool paused = false;
    bool inspect = false;  // pictures come with what the reservoirs hold
    uint64_t restarts = 0; // how often "from the first frame again" was asked for
    uint64_t steps = 0;    // how many single frames were asked for while paused
    bool operator==(const Order&) const = default;
};

// As they are to run: with A's world, and with a part of the resolution while the camera moves.
passes::Settings settingsOf(const Order& order, Side side);

// What a scene offers to the window.
struct SceneFacts {
    std::string name; // as ordered
    std::vector<scene::Camera> cameras;
    glm::dvec3 origin = {0, 0, 0};
    std::vector<std::string> warnings;
};

// One finished picture and how it came about.
struct Shot {
    image::Image picture;
    Order order;      // its `settings` are those of this picture, whichever side; the size is that of the picture
    uint64_t run = 0; // grows whenever a film starts
    uint64_t frames = 0;
    double seconds = 0;  // of rendering, since the film started
    bool single = false; // the last frame alone, not the mean
    passes::RenderStats stats;
    gpu::Adapter adapter;
    double frameMilliseconds = 0; // wall, from frame to frame
    double raysPerSecond = 0;
    std::vector<shared::Inspection> reservoirs; // as passes::Inspector reads them; empty: not asked for, or none there
};
using ShotPointer = std::shared_ptr<const Shot>;

} // namespace ui
