#include "ui/cli/presets.h"

#include "engine/base/error.h"
#include "engine/base/files.h"

#include <algorithm>

#include <generated_presets.h>
#include <nlohmann/json.hpp>

namespace ui
{

namespace
{

constexpr uint64_t MAX_PRESET_BYTES = 1 << 20;

std::string textOf(const std::string& nameOrFile)
{
    for (const auto& [name, text] : EMBEDDED_PRESETS)
        if (nameOrFile == name) return text;
    const std::vector<std::byte> bytes = files::read(nameOrFile, MAX_PRESET_BYTES);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

} // namespace

std::vector<std::string> presetNames()
{
    std::vector<std::string> names;
    for (const auto& [name, text] : EMBEDDED_PRESETS) names.emplace_back(name);
    return names;
}

void applyPreset(passes::Settings& settings, const std::string& nameOrFile)
{
    whileDoing(fmt::format("reading preset \"{}\"", nameOrFile), [&] {
        passes::Settings changed = settings;
        try {
            passes::apply(changed, nlohmann::ordered_json::parse(textOf(nameOrFile)));
        } catch (const nlohmann::json::parse_error& error) {
            throw Error("The preset is not JSON: {}.", error.what());
        }
        settings = changed;
    });
}

} // namespace ui
