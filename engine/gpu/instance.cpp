// The Vulkan instance, its validation layer and messages.

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/gpu/vulkan.h"
#include "engine/gpu/vulkan_lists.h"

#include <algorithm>
#include <string_view>

namespace gpu
{

namespace
{

constexpr const char* VALIDATION_LAYER = "VK_LAYER_KHRONOS_validation";

bool hasInstanceExtension(const char* name)
{
    return holds(listOf<VkExtensionProperties>(vkEnumerateInstanceExtensionProperties, nullptr), name);
}

VkBool32 onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                   const VkDebugUtilsMessengerCallbackDataEXT* data, void* instance)
{
    static_cast<Instance*>(instance)->addMessage(data->pMessage);
    return VK_FALSE;
}

} // namespace

void vkCheck(VkResult result, const char* call, const std::string& label)
{
    switch (result) {
    case VK_SUCCESS: return;
    case VK_ERROR_OUT_OF_HOST_MEMORY: throw Error("Out of memory in {} (\"{}\").", call, label);
    case VK_ERROR_OUT_OF_DEVICE_MEMORY: throw Error("Out of device memory in {} (\"{}\").", call, label);
    case VK_ERROR_DEVICE_LOST:
        throw Error("The Vulkan device was lost in {} (\"{}\"): the driver gave up or was reset.", call, label);
    default: throw Error("The Vulkan driver refuses {} (\"{}\") with VkResult {}.", call, label, int(result));
    }
}

Instance::Instance(bool validation)
{
    std::vector<const char*> wanted;
    std::vector<const char*> extensions;
    canName_ = hasInstanceExtension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (canName_) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (validation) {
        const auto layers = listOf<VkLayerProperties>(vkEnumerateInstanceLayerProperties);
        const auto name = [](const VkLayerProperties& layer) { return std::string_view(layer.layerName); };
        if (std::ranges::find(layers, VALIDATION_LAYER, name) == layers.end())
            throw Error("Validation was asked for, but the Vulkan layer {} is not installed (Debian package "
                        "vulkan-validationlayers).",
                        VALIDATION_LAYER);
        CHECK(canName_);
        wanted.push_back(VALIDATION_LAYER);
        extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    }

    // Drivers that lack some of Vulkan (MoltenVK) are listed only to those who ask; compute needs nothing that they
    // lack.
    const bool portable = hasInstanceExtension(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
    if (portable) extensions.push_back(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);

    const VkDebugUtilsMessengerCreateInfoEXT messengerInfo = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = onMessage,
        .pUserData = this,
    };
    const VkValidationFeatureEnableEXT enables[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    const VkValidationFeaturesEXT features = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .pNext = &messengerInfo, // messages of vkCreateInstance itself
        .enabledValidationFeatureCount = 1,
        .pEnabledValidationFeatures = enables,
    };
    const VkApplicationInfo application = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
        .pApplicationName = "trichrome",
        .apiVersion = VK_API_VERSION_1_2,
    };
    const VkInstanceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pNext = validation ? &features : nullptr,
        .flags = portable ? VkInstanceCreateFlags(VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR) : 0,
        .pApplicationInfo = &application,
        .enabledLayerCount = uint32_t(wanted.size()),
        .ppEnabledLayerNames = wanted.data(),
        .enabledExtensionCount = uint32_t(extensions.size()),
        .ppEnabledExtensionNames = extensions.data(),
    };
    const VkResult result = vkCreateInstance(&info, nullptr, &instance_);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
        throw Error("There is no Vulkan driver on this machine (a software driver is in the Debian package "
                    "mesa-vulkan-drivers).");
    vkCheck(result, "vkCreateInstance", "trichrome");

    if (validation) {
        const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
        vkCheck(create(instance_, &messengerInfo, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT", "trichrome");
    }
}

Instance::~Instance()
{
    if (!instance_) return;
    if (messenger_) {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(instance_, messenger_, nullptr);
    }
    vkDestroyInstance(instance_, nullptr);
}

std::vector<std::string> Instance::takeMessages()
{
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
}

void Instance::addMessage(const std::string& message)
{
    const std::lock_guard lock(mutex_);
    messages_.push_back(message);
}

} // namespace gpu
