#pragma once
// What the window remembers from one time to the next: its size, where its rooms are, recent scenes, camera bookmarks.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ui/window/pose.h"

namespace ui
{

constexpr size_t BOOKMARKS = 9;

struct WindowMemory {
    std::array<int, 2> size = {1280, 720};                                       // points at a scale of 1
    std::string layout;                                                          // ImGui's own words
    std::vector<std::string> recent;                                             // scenes, the latest first
    std::map<std::string, std::array<std::optional<Pose>, BOOKMARKS>> bookmarks; // by scene

    void opened(const std::string& scene); // becomes the latest
    bool operator==(const WindowMemory&) const = default;
};

// Where the XDG base directory specification wants it; empty: nothing is remembered.
std::string memoryFile();

// Nothing to remember, or a file that is not understood: a new memory.
WindowMemory recall(const std::string& file);

// Throws Error: the file cannot be written.
void keep(const WindowMemory& memory, const std::string& file);

} // namespace ui
