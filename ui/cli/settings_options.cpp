#include "ui/cli/settings_options.h"

#include "engine/base/error.h"
#include "engine/base/files.h"

#include <nlohmann/json.hpp>

namespace ui
{

namespace
{

constexpr uint64_t MAX_PRESET_BYTES = 1 << 20;

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

void applyPreset(passes::Settings& settings, const std::string& file)
{
    const std::vector<std::byte> bytes = files::read(file, MAX_PRESET_BYTES);
    whileDoing(fmt::format("reading preset \"{}\"", file), [&] {
        try {
            const char* text = reinterpret_cast<const char*>(bytes.data());
            passes::apply(settings, nlohmann::ordered_json::parse(text, text + bytes.size()));
        } catch (const nlohmann::json::parse_error& error) {
            throw Error("The preset is not JSON: {}.", error.what());
        }
    });
}

void SettingsOptions::addTo(CLI::App& app)
{
    app.add_option("--preset", preset_, "JSON file of settings by name; the other options win over it.")
        ->option_text("FILE")
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

bool SettingsOptions::given(const std::string& name) const
{
    return given_.contains(name) || std::ranges::any_of(assignments_, [&](const std::string& assignment) {
               return split(assignment).first == name;
           });
}

} // namespace ui
