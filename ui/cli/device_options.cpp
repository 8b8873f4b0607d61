#include "ui/cli/device_options.h"

#include "engine/base/error.h"
#include "ui/cli/number_range.h"

#include <fmt/ranges.h>

#include <cstdlib>

namespace ui
{

namespace
{

std::string tuningHelp()
{
    std::string help =
        "For a device that fails or is slow: what its class decides, chosen otherwise (info shows what is "
        "in force). No choice changes pictures but for rounding.";
    for (const gpu::TuningText& text : gpu::describe({}))
        help += fmt::format(" {}={}: {}.", text.name, fmt::join(text.values, "|"), text.meaning);
    return help;
}

// What is wrong with it, in CLI11's terms: empty when nothing is.
std::string complaint(const std::string& tuning)
{
    try {
        gpu::Tuning scratch;
        gpu::applyOverrides(scratch, tuning);
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

} // namespace

// Where the XDG base directory specification wants it.
std::string cacheDirectory()
{
    const char* cache = std::getenv("XDG_CACHE_HOME");
    if (cache && *cache == '/') return std::string(cache) + "/trichrome";
    const char* home = std::getenv("HOME");
    return home && *home ? std::string(home) + "/.cache/trichrome" : "";
}

void DeviceOptions::addTo(CLI::App& app)
{
    app.add_option("--device", device_,
                   "Vulkan device, by index or part of its name, as info lists them; default: a discrete GPU before an "
                   "integrated one before the CPU. Devices differ in the last bits of pixels only.")
        ->option_text("NAME|INDEX");
    app.add_option("--device-tuning", tuning_, tuningHelp())->option_text("NAME=VALUE,...")->check(complaint);
    app.add_option("--shaders", shaders_,
                   "For development: compile the shaders of this directory instead of using those in the executable.")
        ->option_text("DIRECTORY");
    app.add_option(
           "--stall-timeout", stall_,
           "Give up, naming the stage, when the device finishes nothing for so long. Long dispatches are cut into "
           "pieces of about half a second.")
        ->option_text(fmt::format("1 to 86400 s ({})", stall_))
        ->check(within(1.0, 86400.0));
}

gpu::Device DeviceOptions::open(bool robust) const
{
    return gpu::Device::create({.adapter = device_,
                                .tuning = tuning_,
                                .shaderDirectory = shaders_,
                                .cacheDirectory = cacheDirectory(),
                                .stallSeconds = stall_,
                                .robust = robust});
}

} // namespace ui
