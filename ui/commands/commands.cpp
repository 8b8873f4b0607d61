#include "ui/commands/commands.h"

namespace ui
{

std::span<const Command> commands()
{
    static const Command COMMANDS[] = {
        {"render", "Renders a scene to a picture, without a window.", setUpRender, true},
        {"correlate", "How strongly the frames of temporal reuse depend on each other, against M_c.", setUpCorrelate,
         true},
        {"view", "Opens the window: a scene, every setting live.", setUpView},
        {"compare", "Error figures and difference pictures of pictures; with limits, a gate.", setUpCompare},
        {"converge", "Measures error against run time for several methods, as a page.", setUpConverge},
        {"info", "Devices and their limits; or what a scene holds, and what is compiled for it.", setUpInfo},
    };
    return COMMANDS;
}

} // namespace ui
