#pragma once
// --camera-path and --orbit: a camera that moves without a window.

#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "passes/camera_path.h"
#include "passes/settings.h"
#include "ui/cli/output_file.h"
#include "ui/cli/scene_source.h"
#include "ui/cli/settings_options.h"

namespace ui
{

class MotionOptions
{
  public:
    void addTo(CLI::App& app); // must live until the options are read

    bool moving() const { return !path_.empty() || orbit_ != 0; }

    // A mean over frames seen from different places is no picture: with a moving camera --average is off unless the
    // command line asks for it, which is a UsageError unless the path is one keyframe: then nothing moves.
    void adjust(passes::Settings& settings, const SettingsOptions& options) const;

    // Of the camera that the settings choose. Empty when nothing moves. Throws Error: the file.
    passes::CameraAt read(const scene::Scene& scene, const passes::Settings& settings) const;

    void name(NamedFiles& files) const { files.reads("--camera-path", path_); }

    // As metadata, like settings.
    std::vector<std::pair<std::string, std::string>> toText() const;

  private:
    std::string path_;
    double orbit_ = 0; // degrees per frame
};

// What decides the pixels besides settings, as metadata: the scene's pose and the camera's motion.
std::vector<std::pair<std::string, std::string>> motionText(const SceneSource& scene, const MotionOptions& camera);

} // namespace ui
