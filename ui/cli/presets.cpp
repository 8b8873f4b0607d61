#include "ui/cli/presets.h"

#include "engine/base/files.h"
#include "engine/base/json.h"

#include <algorithm>

#include <generated_presets.h>

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
        const std::string text = textOf(nameOrFile);
        passes::apply(changed, parseJson(std::as_bytes(std::span(text))));
        settings = changed;
    });
}

} // namespace ui
