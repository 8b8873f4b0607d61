#pragma once
// GLFW and ImGui, as long as it lives: one window of the screen, at the display's scale.

#include <array>
#include <string>

struct GLFWwindow;

namespace ui
{

class Frame
{
  public:
    // `size`: in points at a scale of 1; never larger than the screen. `layout`: ImGui's words, from layout(). Throws
    // Error: no window can be shown.
    Frame(std::array<int, 2> size, const std::string& layout);
    ~Frame();
    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;

    std::array<int, 2> size() const; // as the constructor takes it
    static std::string layout();

    GLFWwindow* window = nullptr;
    float scale = 1;
};

} // namespace ui
