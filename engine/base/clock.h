#pragma once
// Time that passes, on a clock that is never set.

#include <chrono>

using Clock = std::chrono::steady_clock;

inline double secondsSince(Clock::time_point start, Clock::time_point now = Clock::now())
{
    return std::chrono::duration<double>(now - start).count();
}
