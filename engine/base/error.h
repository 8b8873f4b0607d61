#pragma once
// The one exception of the project: the world is wrong (a file, a device, memory). Our own bugs go through check.h.

#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

// One sentence for a person: what, where, the offending value. Caught only by ui/main.cpp and by tests.
class Error : public std::runtime_error
{
  public:
    explicit Error(const std::string& sentence) : std::runtime_error(sentence) {}

    // Error("Buffer \"{}\" needs {} B.", label, size)
    template <class... Args>
    explicit Error(fmt::format_string<Args...> format, Args&&... args)
        : std::runtime_error(fmt::format(format, std::forward<Args>(args)...))
    {
    }
};

// Runs `work`; an Error that leaves it gains the line "- While <doing>."
template <class Work>
decltype(auto) whileDoing(const std::string& doing, Work&& work)
{
    try {
        return std::forward<Work>(work)();
    } catch (const Error& error) {
        throw Error(std::string(error.what()) + "\n- While " + doing + ".");
    }
}
