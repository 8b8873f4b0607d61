#pragma once
// One line on a terminal that says how far the work is, how fast, and how long it still takes.

#include <string>

#include "engine/base/clock.h"

namespace ui
{

// "63%  40/64 frames  3.20 frames/s  7 s left"; no unit: "63%  7 s left". `total` is 0 when unknown.
std::string progressText(double done, double total, double seconds, const std::string& unit);

class Progress
{
  public:
    // Silent when `quiet`, or when stderr is no terminal.
    explicit Progress(bool quiet);
    ~Progress(); // wipes the line
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // Starts counting time when `what` changes. Redraws at most ten times a second.
    void show(const std::string& what, double done, double total, const std::string& unit = "");
    void clear();

  private:
    bool enabled_ = false;
    bool drawn_ = false;
    std::string what_;
    Clock::time_point start_, drawnAt_;
};

} // namespace ui
