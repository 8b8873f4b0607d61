#pragma once
// The screen's side of Vulkan: an instance, a device that can present, a swapchain. Draws one picture, scaled into a
// rectangle, and Dear ImGui over it. Rendering knows nothing of it and may happen on another device.

#include <cstdint>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

#include "ui/window/tone.h"

struct GLFWwindow;
struct ImDrawData;

namespace ui
{

// In pixels of the framebuffer.
struct Rectangle {
    int x = 0, y = 0, width = 0, height = 0;
};

class Presenter
{
  public:
    explicit Presenter(GLFWwindow* window); // starts ImGui's Vulkan backend; throws Error: nothing can present
    ~Presenter();
    Presenter(const Presenter&) = delete;
    Presenter& operator=(const Presenter&) = delete;

    void setPicture(const ScreenPicture& picture);
    void setTone(const Tone& tone);
    // Shows both. Nothing happens while the window has no area. Throws Error: the device is lost.
    void draw(ImDrawData* widgets, const Rectangle& pictureArea);
    const std::string& deviceName() const { return deviceName_; }

  private:
    struct Target { // one image of the swapchain
        VkImage image = VK_NULL_HANDLE;
        VkImageView view = VK_NULL_HANDLE;
        VkFramebuffer framebuffer = VK_NULL_HANDLE;
        VkSemaphore rendered = VK_NULL_HANDLE;
    };

    struct Block { // a buffer with memory of its own
        VkBuffer buffer = VK_NULL_HANDLE;
        VkDeviceMemory memory = VK_NULL_HANDLE;
    };

    void createInstance();
    void chooseDevice();
    void createDevice();
    void createRenderPass();
    void createDisplay();
    void startWidgets();
    void createSwapchain();
    void destroySwapchain();
    void destroyPicture();
    void destroy();
    VkDeviceMemory allocate(const VkMemoryRequirements& need, VkMemoryPropertyFlags properties) const;
    void createBlock(Block& block, VkDeviceSize bytes, VkBufferUsageFlags usage, VkMemoryPropertyFlags properties);
    void createPicture(uint32_t width, uint32_t height);
    void recordPicture(VkCommandBuffer commands, VkImage target, const Rectangle& area) const;

    GLFWwindow* window_;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    uint32_t family_ = 0;
    std::string deviceName_;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    VkCommandPool commandPool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkDescriptorPool descriptorPool_ = VK_NULL_HANDLE;
    VkFence idle_ = VK_NULL_HANDLE; // the one frame in flight is done
    VkSemaphore acquired_ = VK_NULL_HANDLE;
    VkSurfaceFormatKHR format_ = {};
    VkRenderPass renderPass_ = VK_NULL_HANDLE;
    bool widgetsStarted_ = false;

    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    VkExtent2D extent_ = {0, 0};
    std::vector<Target> targets_;

    VkExtent2D pictureExtent_ = {0, 0};
    VkImage picture_ = VK_NULL_HANDLE;
    VkDeviceMemory pictureMemory_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout displayLayout_ = VK_NULL_HANDLE; // of shaders/display.comp
    VkPipelineLayout displayPipelineLayout_ = VK_NULL_HANDLE;
    VkPipeline display_ = VK_NULL_HANDLE;
    VkDescriptorSet displaySet_ = VK_NULL_HANDLE;
    Block linear_, screen_; // what it reads and writes
    VkBufferView linearView_ = VK_NULL_HANDLE;
    void* linearBytes_ = nullptr;
    Tone tone_;
    bool displayDue_ = false;
};

// Throws Error: what failed, with the code.
void checkVulkan(VkResult result, const char* what);

} // namespace ui
