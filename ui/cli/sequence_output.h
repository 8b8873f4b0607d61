#pragma once
// --sequence, --warm-up and --restart: which frames are rendered, after which of them history begins anew, and which
// become files of their own.

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "passes/settings.h"
#include "ui/cli/frame_chains.h"
#include "ui/cli/settings_options.h"

namespace ui
{

class SequenceOutput
{
  public:
    void addTo(CLI::App& app); // must live until the options are read

    bool given() const { return !range_.empty(); }
    // Reads the range, and takes --frames and --average from it; without one, --frames or --seconds say what there is.
    // `pattern` is --output. Throws UsageError: no range, too long, a pattern without a number, options that say
    // something else.
    void adjust(passes::Settings& settings, const SettingsOptions& options, const std::string& pattern);

    bool restarts() const { return restart_ > 0; }
    const FrameChains& chains() const { return chains_; }
    // Of the frame at a place. Nothing for one of a warm-up, or without --sequence.
    std::filesystem::path fileOf(uint64_t place) const;

    // As metadata, like settings: what decides the frame at each place. The number of frames may change.
    std::vector<std::pair<std::string, std::string>> toText() const;

  private:
    void readRange(passes::Settings& settings, const SettingsOptions& options, const std::string& pattern);

    std::string range_, pattern_;
    uint32_t warmUp_ = 0, restart_ = 0;
    FrameChains chains_;
};

} // namespace ui
