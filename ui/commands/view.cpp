// view [SCENE]: the window.

#include "ui/cli/output_file.h"
#include "ui/cli/settings_options.h"
#include "ui/commands/commands.h"
#include "ui/window/window.h"

#include <memory>

namespace ui
{

namespace
{

struct ViewCommand {
    WindowOptions window;
    SettingsOptions settings;

    int run()
    {
        window.order.settings = settings.read();
        if (!window.report.empty()) requireWritable(window.report);
        showWindow(window);
        return 0;
    }
};

} // namespace

Action setUpView(CLI::App& app)
{
    const auto command = std::make_shared<ViewCommand>();
    command->window.order.scene = "hall";
    app.add_option("SCENE", command->window.order.scene,
                   "A .gltf or .glb file, or a built-in scene; without one: hall.");
    app.add_option("--reference", command->window.reference,
                   "Picture to measure errors against over time: EXR, or a PNG that this program wrote.")
        ->option_text("FILE");
    app.add_option("--report", command->window.report,
                   "Keeps writing what the window shows, for scripts: settings, frames, camera, errors, messages.")
        ->option_text("FILE.json");
    command->window.device.addTo(app);
    command->settings.addTo(app);
    return [command] { return command->run(); };
}

} // namespace ui
