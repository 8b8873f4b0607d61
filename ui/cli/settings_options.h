#pragma once
// The options of every setting, made from the one list of settings: --preset, --set, and one option per setting.

#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "passes/settings.h"
#include "ui/cli/output_file.h"

namespace ui
{

class SettingsOptions
{
  public:
    // `defaults`: of this command, where they differ from those of Settings.
    explicit SettingsOptions(const passes::Settings& defaults = {}) : defaults_(defaults) {}

    // Adds the options to `app`; must live until they are read. Values are checked while parsing (wrong usage).
    void addTo(CLI::App& app);

    // The defaults, then the preset, then --set in order, then the settings' own options. Throws Error: the preset.
    passes::Settings read() const;

    // The preset, if it is a file, and the environment of the settings that read() gave.
    void name(NamedFiles& files, const passes::Settings& settings) const;

    // Whether the command line itself, not a preset, says something about the setting.
    bool given(const std::string& name) const;

  private:
    passes::Settings defaults_;
    std::string preset_;
    std::vector<std::string> assignments_;     // "name=value"
    std::map<std::string, std::string> given_; // of the settings' own options
};

} // namespace ui
