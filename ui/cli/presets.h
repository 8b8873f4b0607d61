#pragma once
// Settings from JSON: a file, or one of those that come along (assets/presets/*.json).

#include <string>
#include <vector>

#include "passes/settings.h"

namespace ui
{

// Names of those that come along: "offline", "paper", "real-time".
std::vector<std::string> presetNames();

// Changes what the preset names, nothing else. A file of a built-in's name must be said with its folder or extension.
// Throws Error naming the preset: not there, not JSON, an unknown setting or a value that it cannot have.
void applyPreset(passes::Settings& settings, const std::string& nameOrFile);

} // namespace ui
