#include "ui/cli/motion_options.h"

#include "passes/camera_path.h"
#include "ui/cli/number_range.h"
#include "ui/cli/usage_error.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

namespace ui
{

void MotionOptions::addTo(CLI::App& app)
{
    CLI::Option* path = app.add_option(
        "--camera-path", path_,
        "JSON file {\"keyframes\": [{\"frame\", \"position\", \"target\", \"up\", \"yfov\"}, ...]}: where the camera "
        "is at "
        "which frame, in the scene's coordinates; up (+y) and yfov (degrees) may be left out. Smooth in between. "
        "Writes the last frame: --average is off.");
    path->option_text("FILE")->group("Camera motion");
    app.add_option(
           "--orbit", orbit_,
           "Turns the camera about the vertical through the point it looks at, counter-clockwise seen from above. "
           "Writes the last frame: --average is off.")
        ->option_text("DEGREES per frame, -180 to 180 (0)")
        ->check(within(-180.0, 180.0))
        ->excludes(path)
        ->group("Camera motion");
}

void MotionOptions::adjust(passes::Settings& settings, const SettingsOptions& options) const
{
    if (!moving()) return;
    if (options.given("average") && settings.average && !path_.empty() && passes::standsStill(path_)) return;
    if (settings.average && options.given("average"))
        throw UsageError(
            "--average on cannot be combined with {}: the mean of frames seen from different places is no picture.",
            path_.empty() ? "--orbit" : "--camera-path");
    settings.average = false;
}

passes::CameraAt MotionOptions::read(const scene::Scene& scene, const passes::Settings& settings) const
{
    if (!moving()) return {};
    const scene::Camera& base = scene.cameras[passes::chooseCamera(scene, settings.camera)];
    return path_.empty() ? passes::cameraOrbit(base, orbit_) : passes::loadCameraPath(path_, base, scene.origin);
}

std::vector<std::pair<std::string, std::string>> MotionOptions::toText() const
{
    if (!moving()) return {};
    if (path_.empty()) return {{"orbit", fmt::format("{}", orbit_)}};
    return {{"camera-path", path_}};
}

std::vector<std::pair<std::string, std::string>> motionText(const SceneSource& scene, const MotionOptions& camera)
{
    std::vector<std::pair<std::string, std::string>> text = scene.toText();
    std::ranges::move(camera.toText(), std::back_inserter(text));
    return text;
}

} // namespace ui
