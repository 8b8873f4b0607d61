#pragma once
// --checkpoint, --checkpoint-interval and --resume: long renders that survive whatever ends them.

#include <cstdint>
#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "engine/base/clock.h"
#include "passes/checkpoint.h"
#include "ui/cli/output_file.h"
#include "ui/cli/run_report.h"

namespace ui
{

class CheckpointOptions
{
  public:
    void addTo(CLI::App& app);    // must live until the options are read
    void requireWritable() const; // throws Error
    void name(NamedFiles& files) const;
    bool given() const { return !checkpoint_.empty() || resumes(); }
    bool resumes() const { return !resume_.empty(); }

    // Before the first frame: goes on from --resume's file, if given, and returns the seconds rendered before. `bring`
    // takes the renderer to what a frame, counted from 0, shows. Throws Error: no such file, damaged, or of another
    // render.
    double start(passes::Renderer& renderer, const RunReport& report, const std::function<void(uint64_t frame)>& bring);

    // After a frame: writes --checkpoint's file, if given, at most once an interval. That it cannot be written is a
    // warning, for the render itself is well.
    void keep(passes::Renderer& renderer, double seconds);

    // At the end, or on Ctrl-C, before anything else that could fail. Returns whether all is well; warns otherwise.
    bool finish(passes::Renderer& renderer, double seconds) const;

  private:
    bool write(passes::Renderer& renderer, double seconds, const char* consequence) const;

    std::string checkpoint_, resume_;
    double interval_ = 300; // s
    passes::Identity identity_;
    Clock::time_point kept_;
};

} // namespace ui
