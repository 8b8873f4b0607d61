#pragma once
// What moves from frame to frame without a window: --camera-path and --orbit move the camera, --fps plays the scene's
// animations.

#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "passes/sequence.h"
#include "passes/settings.h"
#include "ui/cli/output_file.h"
#include "ui/cli/scene_source.h"
#include "ui/cli/settings_options.h"

namespace ui
{

// --fps, --speed and --loop: how a scene's animations play.
struct Play {
    double fps = 0; // frames a second; 0: the scene is held still
    double speed = 1;
    bool loop = true;
    bool operator==(const Play&) const = default;

    // Must live until the options are read. `doc` is of --fps.
    void addTo(CLI::App& app, const std::string& doc);
    // A scene that plays begins at 0 s if --time does not say otherwise. Throws UsageError: --animation off.
    void adjust(SceneSource& source) const;
    bool moves() const { return fps > 0 && speed != 0; }
    passes::Playback playback(std::vector<uint32_t> animations, double start) const; // fps is not 0

    // As metadata, like settings.
    std::vector<std::pair<std::string, std::string>> toText() const;
};

class MotionOptions
{
  public:
    void addTo(CLI::App& app); // must live until the options are read

    bool moving() const { return !path_.empty() || orbit_ != 0 || play_.moves(); }

    // A mean over frames that show different things is no picture: where something moves --average is off unless the
    // command line asks for it, which is a UsageError unless it is only a camera path of one keyframe: then nothing
    // moves.
    void adjust(passes::Settings& settings, const SettingsOptions& options, SceneSource& source) const;

    // Of the camera that the settings choose; `scene` is that of `source`, is at rest afterwards if it plays, as
    // renderers want it, and is posed in place by what is returned. Throws Error: the file.
    passes::Sequence read(scene::Scene& scene, const passes::Settings& settings, const SceneSource& source) const;

    void name(NamedFiles& files) const { files.reads("--camera-path", path_); }

    // As metadata, like settings.
    std::vector<std::pair<std::string, std::string>> toText() const;

  private:
    std::string path_;
    double orbit_ = 0; // degrees per frame
    Play play_;
};

// What decides the pixels besides settings, as metadata: the scene's pose and the camera's motion.
std::vector<std::pair<std::string, std::string>> motionText(const SceneSource& scene, const MotionOptions& camera);

} // namespace ui
