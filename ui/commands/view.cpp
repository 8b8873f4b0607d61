// view [SCENE]: the window.

#include "ui/cli/output_file.h"
#include "ui/cli/scene_source.h"
#include "ui/cli/settings_options.h"
#include "ui/commands/commands.h"
#include "ui/window/window.h"

#include <memory>

namespace ui
{

namespace
{

struct ViewCommand {
    WindowOptions window{.order = {.scene = {.name = "hall"}}};
    Play play;
    std::string path;
    SettingsOptions settings;

    int run()
    {
        window.order.settings = settings.read();
        play.adjust(window.order.scene);
        if (play.fps > 0) {
            window.order.play = play;
            window.order.playing = true;
        }
        if (!path.empty()) {
            window.order.path = loadKeys(path);
            window.order.playing = true;
        }
        NamedFiles files;
        files.writes("--report", window.report);
        files.reads("--reference", window.reference);
        files.reads("--camera-path", path);
        settings.name(files, window.order.settings);
        files.reads("SCENE", window.order.scene.name);
        if (!window.report.empty()) requireWritable(window.report);
        showWindow(window);
        return 0;
    }
};

} // namespace

Action setUpView(CLI::App& app)
{
    const auto command = std::make_shared<ViewCommand>();
    addSceneOptions(app, command->window.order.scene, "A .gltf or .glb file, or a built-in scene; without one: hall.");
    app.add_option("--reference", command->window.reference,
                   "Picture to measure errors against over time: EXR, or a PNG that this program wrote.")
        ->option_text("FILE");
    app.add_option("--report", command->window.report,
                   "Keeps writing what the window shows, for scripts: settings, frames, camera, errors, messages.")
        ->option_text("FILE.json");
    app.add_option("--camera-path", command->path,
                   "Begins by moving the camera as render --camera-path does, a keyframe's frame being one that is "
                   "rendered; T stops it. The window records such files (M).")
        ->option_text("FILE")
        ->group("Camera motion");
    command->play.addTo(app, "Begins by playing the scene's animations (those of --animation), from --time on: each "
                             "rendered frame shows it 1/FPS seconds later. 0: it is held still.");
    command->window.device.addTo(app);
    command->settings.addTo(app);
    return [command] { return command->run(); };
}

} // namespace ui
