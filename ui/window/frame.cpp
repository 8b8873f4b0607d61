#include "ui/window/frame.h"

#include "engine/base/error.h"

#include <algorithm>
#include <cmath>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

namespace ui
{

namespace
{

std::string& lastError()
{
    static std::string text;
    return text;
}

} // namespace

Frame::Frame(std::array<int, 2> size, const std::string& layout)
{
    glfwSetErrorCallback([](int, const char* text) { lastError() = text; });
    if (!glfwInit()) throw Error("No window can be shown: {}.", lastError());
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    float vertical = 1;
    if (GLFWmonitor* monitor = glfwGetPrimaryMonitor()) {
        glfwGetMonitorContentScale(monitor, &scale, &vertical);
        int x = 0, y = 0, width = 0, height = 0;
        glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
        size = {std::min(int(float(size[0]) * scale), width), std::min(int(float(size[1]) * scale), height)};
    }
    if (!glfwVulkanSupported() || !(window = glfwCreateWindow(size[0], size[1], "Trichrome", nullptr, nullptr))) {
        const std::string why = window || lastError().empty() ? "there is no Vulkan driver" : lastError();
        glfwTerminate();
        throw Error("No window can be shown: {}.", why);
    }
    glfwGetWindowContentScale(window, &scale, &vertical);
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // kept by WindowMemory
    ImGui::LoadIniSettingsFromMemory(layout.c_str(), layout.size());
    ImGui::StyleColorsDark();
    ImGui::GetStyle().ScaleAllSizes(scale);
    ImFontConfig font;
    font.SizePixels = std::floor(13 * scale);
    ImGui::GetIO().Fonts->AddFontDefault(&font);
}

Frame::~Frame()
{
    ImGui::DestroyContext();
    glfwDestroyWindow(window);
    glfwTerminate();
}

std::array<int, 2> Frame::size() const
{
    int width = 0, height = 0;
    glfwGetWindowSize(window, &width, &height);
    return {int(std::lround(float(width) / scale)), int(std::lround(float(height) / scale))};
}

std::string Frame::layout()
{
    size_t length = 0;
    const char* text = ImGui::SaveIniSettingsToMemory(&length);
    return {text, length};
}

} // namespace ui
