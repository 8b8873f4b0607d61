#include "ui/cli/motion_options.h"

#include "engine/scene/motion.h"
#include "ui/cli/number_range.h"
#include "ui/cli/usage_error.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

namespace ui
{

void Play::addTo(CLI::App& app, const std::string& doc)
{
    CLI::Option* option = app.add_option("--fps", fps, doc);
    option->option_text("0 to 1000 (0)")->check(within(0.0, 1000.0))->group("Animation");
    app.add_option("--speed", speed,
                   "How fast it plays; negative: backwards; 0: held still at --time, as a scene that "
                   "could move.")
        ->option_text("-100 to 100 (1)")
        ->check(within(-100.0, 100.0))
        ->needs(option)
        ->group("Animation");
    app.add_option_function<std::string>(
           "--loop", [this](const std::string& word) { loop = word == "on"; },
           "Whether it begins again after the last key; off: it stays as it is there.")
        ->option_text("on|off (on)")
        ->check([](const std::string& value) {
            return value == "on" || value == "off" ? std::string()
                                                   : fmt::format("\"{}\" is neither on nor off.", value);
        })
        ->needs(option)
        ->group("Animation");
}

void Play::adjust(SceneSource& source) const
{
    if (fps == 0) return;
    if (source.animation == "off")
        throw UsageError("--fps plays animations, and --animation off leaves none: leave out one of the two.");
    if (!source.time) source.time = 0;
}

passes::Playback Play::playback(std::vector<uint32_t> animations, double start) const
{
    return {.animations = std::move(animations), .start = start, .step = speed / fps, .loop = loop};
}

std::vector<std::pair<std::string, std::string>> Play::toText() const
{
    if (fps == 0) return {};
    return {{"fps", fmt::format("{}", fps)}, {"speed", fmt::format("{}", speed)}, {"loop", loop ? "on" : "off"}};
}

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
    play_.addTo(app,
                "Plays the scene's animations (those of --animation): frame 0 shows it at --time, each later one "
                "1/FPS seconds of it further. Writes the last frame: --average is off. 0: the scene is held still.");
}

void MotionOptions::adjust(passes::Settings& settings, const SettingsOptions& options, SceneSource& source) const
{
    play_.adjust(source);
    if (!moving()) return;
    const bool onlyPath = !path_.empty() && !play_.moves();
    if (options.given("average") && settings.average && onlyPath && passes::standsStill(path_)) return;
    if (settings.average && options.given("average"))
        throw UsageError(
            "--average on cannot be combined with {}: the mean of frames that show different things is no picture.",
            play_.moves()   ? "--fps"
            : path_.empty() ? "--orbit"
                            : "--camera-path");
    settings.average = false;
}

passes::Sequence MotionOptions::read(scene::Scene& scene, const passes::Settings& settings,
                                     const SceneSource& source) const
{
    const uint32_t camera = passes::chooseCamera(scene, settings.camera);
    passes::CameraAt cameraAt;
    if (!path_.empty())
        cameraAt = passes::loadCameraPath(path_, scene.cameras[camera], scene.origin);
    else if (orbit_ != 0)
        cameraAt = passes::cameraOrbit(scene.cameras[camera], orbit_);
    const std::vector<uint32_t> chosen = play_.fps > 0 ? chosenAnimations(scene, source) : std::vector<uint32_t>();
    if (chosen.empty()) return cameraAt;
    scene::pose(scene, {}, 0);
    return {scene, play_.playback(chosen, source.time.value_or(0)), camera, cameraAt};
}

std::vector<std::pair<std::string, std::string>> MotionOptions::toText() const
{
    std::vector<std::pair<std::string, std::string>> text;
    if (!path_.empty()) text.emplace_back("camera-path", path_);
    if (orbit_ != 0) text.emplace_back("orbit", fmt::format("{}", orbit_));
    std::ranges::move(play_.toText(), std::back_inserter(text));
    return text;
}

std::vector<std::pair<std::string, std::string>> motionText(const SceneSource& scene, const MotionOptions& camera)
{
    std::vector<std::pair<std::string, std::string>> text = scene.toText();
    std::ranges::move(camera.toText(), std::back_inserter(text));
    return text;
}

} // namespace ui
