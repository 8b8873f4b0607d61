#pragma once
// --sequence and --warm-up: every frame of a render as a file of its own.

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "passes/settings.h"
#include "ui/cli/settings_options.h"

namespace ui
{

class SequenceOutput
{
  public:
    void addTo(CLI::App& app); // must live until the options are read

    bool given() const { return !range_.empty(); }
    // Reads the range, and takes --frames and --average from it. `pattern` is --output. Throws UsageError: no range,
    // too long, a pattern without a number, options that say something else.
    void adjust(passes::Settings& settings, const SettingsOptions& options, const std::string& pattern);

    // The number of a frame by its place among those rendered, warm-up first; negative: before the first of all.
    int64_t numberOf(uint64_t rendered) const { return first_ - int64_t(warmUp_) + int64_t(rendered); }
    // Nothing for a frame of the warm-up, and where none is asked for.
    std::filesystem::path fileOf(uint64_t rendered) const;

    // As metadata, like settings: what decides which frame has which history.
    std::vector<std::pair<std::string, std::string>> toText() const;

  private:
    std::string range_, pattern_;
    int64_t first_ = 0, end_ = 0;
    uint32_t warmUp_ = 0;
};

} // namespace ui
