// Presenter: what is made once.

#include "ui/window/presenter.h"

#include "engine/base/error.h"
#include "engine/gpu/shader.h"
#include "engine/gpu/vulkan_lists.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_vulkan.h>

namespace ui
{

namespace
{

constexpr uint32_t MIN_IMAGES = 2;
constexpr VkQueueFlags NEEDED = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;

// Discrete before integrated before the rest.
int rankOf(VkPhysicalDeviceType type)
{
    return type == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU ? 2 : type == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU ? 1 : 0;
}

} // namespace

void checkVulkan(VkResult result, const char* what)
{
    if (result < 0) throw Error("The window's device failed in {} (Vulkan error {}).", what, int(result));
}

Presenter::Presenter(GLFWwindow* window) : window_(window)
{
    try {
        createInstance();
        chooseDevice();
        createDevice();
        createRenderPass();
        createDisplay();
        startWidgets();
    } catch (...) {
        destroy();
        throw;
    }
}

void Presenter::createInstance()
{
    uint32_t count = 0;
    const char** extensions = glfwGetRequiredInstanceExtensions(&count);
    if (!extensions) throw Error("No window can be shown: no Vulkan driver of this machine draws into windows.");
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                           .pApplicationName = "Trichrome's window",
                                           .apiVersion = VK_API_VERSION_1_2};
    const VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                       .pApplicationInfo = &application,
                                       .enabledExtensionCount = count,
                                       .ppEnabledExtensionNames = extensions};
    checkVulkan(vkCreateInstance(&info, nullptr, &instance_), "vkCreateInstance");
    checkVulkan(glfwCreateWindowSurface(instance_, window_, nullptr, &surface_), "glfwCreateWindowSurface");
}

void Presenter::chooseDevice()
{
    int best = -1;
    for (const VkPhysicalDevice device : gpu::listOf<VkPhysicalDevice>(vkEnumeratePhysicalDevices, instance_)) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(device, &properties);
        const auto extensions =
            gpu::listOf<VkExtensionProperties>(vkEnumerateDeviceExtensionProperties, device, nullptr);
        if (!gpu::holds(extensions, VK_KHR_SWAPCHAIN_EXTENSION_NAME)) continue;
        if (rankOf(properties.deviceType) <= best) continue;
        if (properties.apiVersion < VK_API_VERSION_1_2) continue; // as shaders are compiled for
        const auto families = gpu::listOf<VkQueueFamilyProperties>(vkGetPhysicalDeviceQueueFamilyProperties, device);
        for (uint32_t family = 0; family < families.size(); ++family) {
            VkBool32 presents = VK_FALSE;
            vkGetPhysicalDeviceSurfaceSupportKHR(device, family, surface_, &presents);
            if (!presents || (families[family].queueFlags & NEEDED) != NEEDED) continue;
            best = rankOf(properties.deviceType);
            physical_ = device;
            family_ = family;
            deviceName_ = properties.deviceName;
            break;
        }
    }
    if (best < 0)
        throw Error("No window can be shown: none of the Vulkan devices can draw into a window of this display.");
}

void Presenter::createDevice()
{
    const float priority = 1;
    const VkDeviceQueueCreateInfo queueInfo = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                               .queueFamilyIndex = family_,
                                               .queueCount = 1,
                                               .pQueuePriorities = &priority};
    const char* extension = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queueInfo,
                                     .enabledExtensionCount = 1,
                                     .ppEnabledExtensionNames = &extension};
    checkVulkan(vkCreateDevice(physical_, &info, nullptr, &device_), "vkCreateDevice");
    vkGetDeviceQueue(device_, family_, 0, &queue_);

    const VkCommandPoolCreateInfo poolInfo = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                              .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                              .queueFamilyIndex = family_};
    checkVulkan(vkCreateCommandPool(device_, &poolInfo, nullptr, &commandPool_), "vkCreateCommandPool");
    const VkCommandBufferAllocateInfo commandInfo = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                     .commandPool = commandPool_,
                                                     .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                     .commandBufferCount = 1};
    checkVulkan(vkAllocateCommandBuffers(device_, &commandInfo, &commands_), "vkAllocateCommandBuffers");
    const VkFenceCreateInfo fenceInfo = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                                         .flags = VK_FENCE_CREATE_SIGNALED_BIT};
    checkVulkan(vkCreateFence(device_, &fenceInfo, nullptr, &idle_), "vkCreateFence");
    const VkSemaphoreCreateInfo semaphoreInfo = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    checkVulkan(vkCreateSemaphore(device_, &semaphoreInfo, nullptr, &acquired_), "vkCreateSemaphore");
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1}, // the font
                                          {VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, 1},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}};
    const VkDescriptorPoolCreateInfo descriptorInfo = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                                       .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
                                                       .maxSets = 2,
                                                       .poolSizeCount = uint32_t(std::size(sizes)),
                                                       .pPoolSizes = sizes};
    checkVulkan(vkCreateDescriptorPool(device_, &descriptorInfo, nullptr, &descriptorPool_), "vkCreateDescriptorPool");
}

// Over what is there already: the picture. Colors are sRGB-encoded numbers throughout, so the format must not encode.
void Presenter::createRenderPass()
{
    const VkFormat formats[] = {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM};
    format_ = ImGui_ImplVulkanH_SelectSurfaceFormat(physical_, surface_, formats, int(std::size(formats)),
                                                    VK_COLORSPACE_SRGB_NONLINEAR_KHR);
    const VkAttachmentDescription attachment = {.format = format_.format,
                                                .samples = VK_SAMPLE_COUNT_1_BIT,
                                                .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                                .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                                .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                                .initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                                .finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};
    const VkAttachmentReference reference = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                          .colorAttachmentCount = 1,
                                          .pColorAttachments = &reference};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 1,
                                         .pAttachments = &attachment,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass};
    checkVulkan(vkCreateRenderPass(device_, &info, nullptr, &renderPass_), "vkCreateRenderPass");
}

// Tables as texel buffers: the largest pictures fit into those.
void Presenter::createDisplay()
{
    const VkDescriptorSetLayoutBinding bindings[] = {{.binding = 0,
                                                      .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER,
                                                      .descriptorCount = 1,
                                                      .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT},
                                                     {.binding = 1,
                                                      .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                                      .descriptorCount = 1,
                                                      .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT}};
    const VkDescriptorSetLayoutCreateInfo layoutInfo = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                        .bindingCount = uint32_t(std::size(bindings)),
                                                        .pBindings = bindings};
    checkVulkan(vkCreateDescriptorSetLayout(device_, &layoutInfo, nullptr, &displayLayout_),
                "vkCreateDescriptorSetLayout");
    const VkDescriptorSetAllocateInfo setInfo = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                                 .descriptorPool = descriptorPool_,
                                                 .descriptorSetCount = 1,
                                                 .pSetLayouts = &displayLayout_};
    checkVulkan(vkAllocateDescriptorSets(device_, &setInfo, &displaySet_), "vkAllocateDescriptorSets");
    const VkPipelineLayoutCreateInfo pipelineLayoutInfo = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, .setLayoutCount = 1, .pSetLayouts = &displayLayout_};
    checkVulkan(vkCreatePipelineLayout(device_, &pipelineLayoutInfo, nullptr, &displayPipelineLayout_),
                "vkCreatePipelineLayout");
    const std::vector<uint32_t> words = gpu::loadShader("display", true);
    const VkShaderModuleCreateInfo moduleInfo = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                                 .codeSize = words.size() * sizeof(uint32_t),
                                                 .pCode = words.data()};
    VkShaderModule module = VK_NULL_HANDLE;
    checkVulkan(vkCreateShaderModule(device_, &moduleInfo, nullptr, &module), "vkCreateShaderModule");
    const VkComputePipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                              .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                        .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                        .module = module,
                                                        .pName = "main"},
                                              .layout = displayPipelineLayout_};
    const VkResult made = vkCreateComputePipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr, &display_);
    vkDestroyShaderModule(device_, module, nullptr);
    checkVulkan(made, "vkCreateComputePipelines");
}

void Presenter::startWidgets()
{
    ImGui_ImplVulkan_InitInfo info = {};
    info.Instance = instance_;
    info.PhysicalDevice = physical_;
    info.Device = device_;
    info.QueueFamily = family_;
    info.Queue = queue_;
    info.DescriptorPool = descriptorPool_;
    info.MinImageCount = MIN_IMAGES;
    info.ImageCount = MIN_IMAGES; // one frame in flight: as many sets of vertex buffers suffice
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    ImGui_ImplVulkan_Init(&info, renderPass_);
    widgetsStarted_ = true;

    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    checkVulkan(vkBeginCommandBuffer(commands_, &begin), "vkBeginCommandBuffer");
    ImGui_ImplVulkan_CreateFontsTexture(commands_);
    checkVulkan(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
    const VkSubmitInfo submit = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands_};
    checkVulkan(vkQueueSubmit(queue_, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
    checkVulkan(vkQueueWaitIdle(queue_), "vkQueueWaitIdle");
    ImGui_ImplVulkan_DestroyFontUploadObjects();
}

Presenter::~Presenter()
{
    destroy();
}

void Presenter::destroy()
{
    if (device_) {
        vkDeviceWaitIdle(device_);
        if (widgetsStarted_) ImGui_ImplVulkan_Shutdown();
        destroyPicture();
        destroySwapchain();
        vkDestroyPipeline(device_, display_, nullptr);
        vkDestroyPipelineLayout(device_, displayPipelineLayout_, nullptr);
        vkDestroyDescriptorSetLayout(device_, displayLayout_, nullptr);
        vkDestroyRenderPass(device_, renderPass_, nullptr);
        vkDestroyDescriptorPool(device_, descriptorPool_, nullptr);
        vkDestroySemaphore(device_, acquired_, nullptr);
        vkDestroyFence(device_, idle_, nullptr);
        vkDestroyCommandPool(device_, commandPool_, nullptr);
        vkDestroyDevice(device_, nullptr);
    }
    if (surface_) vkDestroySurfaceKHR(instance_, surface_, nullptr);
    if (instance_) vkDestroyInstance(instance_, nullptr);
}

} // namespace ui
