#include "ui/cli/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <unistd.h>

namespace ui
{

namespace
{

constexpr int BAR_CELLS = 24;
constexpr double REDRAW_SECONDS = 0.1;

std::string durationText(double seconds)
{
    const auto whole = std::llround(seconds);
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

} // namespace

std::string progressText(double done, double total, double seconds, const std::string& unit)
{
    std::string text = total > 0 ? fmt::format("{:.0f}%", 100 * std::min(done / total, 1.0)) : "";
    const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "  ") + part; };
    if (!unit.empty()) {
        add(total > 0 ? fmt::format("{:.0f}/{:.0f} {}", done, total, unit) : fmt::format("{:.0f} {}", done, unit));
        if (seconds > 0) add(fmt::format("{:.3g} {}/s", done / seconds, unit));
    }
    if (total > 0 && done > 0) add(durationText(std::max(total - done, 0.0) * seconds / done) + " left");
    return text;
}

Progress::Progress(bool quiet) : enabled_(!quiet && isatty(STDERR_FILENO) != 0) {}

Progress::~Progress()
{
    clear();
}

void Progress::show(const std::string& what, double done, double total, const std::string& unit)
{
    if (!enabled_) return;
    const Clock::time_point now = Clock::now();
    if (what != what_) {
        what_ = what;
        start_ = now;
    } else if (secondsSince(drawnAt_, now) < REDRAW_SECONDS) {
        return;
    }
    drawnAt_ = now;
    drawn_ = true;
    const double fraction = total > 0 ? std::min(done / total, 1.0) : 0;
    const int filled = static_cast<int>(fraction * BAR_CELLS);
    const double seconds = secondsSince(start_, now);
    std::fputs(fmt::format("\r\033[K{} [{}{}] {}", what, std::string(size_t(filled), '#'),
                           std::string(size_t(BAR_CELLS - filled), '.'), progressText(done, total, seconds, unit))
                   .c_str(),
               stderr);
    std::fflush(stderr);
}

void Progress::clear()
{
    if (drawn_) std::fputs("\r\033[K", stderr);
    drawn_ = false;
}

} // namespace ui
