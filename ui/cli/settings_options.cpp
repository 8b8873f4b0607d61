#include "ui/cli/settings_options.h"

#include "engine/base/error.h"
#include "ui/cli/presets.h"

#include <fmt/ranges.h>

namespace ui
{

namespace
{

std::pair<std::string, std::string> split(const std::string& assignment)
{
    const size_t equals = assignment.find('=');
    if (equals == std::string::npos) throw Error("\"{}\" is not of the form name=value.", assignment);
    return {assignment.substr(0, equals), assignment.substr(equals + 1)};
}

// What is wrong with a value, in CLI11's terms: empty when nothing is.
std::string complaint(const std::string& name, const std::string& value)
{
    try {
        passes::Settings scratch;
        passes::set(scratch, name, value);
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

} // namespace

void SettingsOptions::addTo(CLI::App& app)
{
    app.add_option("--preset", preset_,
                   fmt::format("JSON file of settings by name, or one of: {}. The other options win over it.",
                               fmt::join(presetNames(), ", ")))
        ->option_text("FILE|NAME")
        ->group("Settings");
    app.add_option("--set", assignments_, "One setting by name, as often as needed; its own option wins over it.")
        ->option_text("NAME=VALUE")
        ->allow_extra_args(false)
        ->check([](const std::string& assignment) -> std::string {
            try {
                const auto [name, value] = split(assignment);
                return complaint(name, value);
            } catch (const Error& error) {
                return error.what();
            }
        })
        ->group("Settings");
    for (const passes::KnobText& knob : passes::describeSettings(defaults_)) {
        app.add_option_function<std::string>(
               "--" + knob.name, [this, name = knob.name](const std::string& value) { given_[name] = value; }, knob.doc)
            ->option_text(fmt::format("{} ({})", knob.values, knob.initial.empty() ? "empty" : knob.initial))
            ->check([name = knob.name](const std::string& value) { return complaint(name, value); })
            ->group("Settings");
    }
}

passes::Settings SettingsOptions::read() const
{
    passes::Settings settings = defaults_;
    if (!preset_.empty()) applyPreset(settings, preset_);
    for (const std::string& assignment : assignments_) {
        const auto [name, value] = split(assignment);
        passes::set(settings, name, value);
    }
    for (const auto& [name, value] : given_) passes::set(settings, name, value);
    return settings;
}

void SettingsOptions::name(NamedFiles& files, const passes::Settings& settings) const
{
    if (const std::vector<std::string> names = presetNames(); std::ranges::find(names, preset_) == names.end())
        files.reads("--preset", preset_);
    files.reads("--environment", settings.environment);
}

bool SettingsOptions::given(const std::string& name) const
{
    return given_.contains(name) || std::ranges::any_of(assignments_, [&](const std::string& assignment) {
               return split(assignment).first == name;
           });
}

} // namespace ui
