// Which physical devices there are, what they can do, and which one is meant.

#include "engine/base/error.h"
#include "engine/gpu/vulkan.h"
#include "engine/gpu/vulkan_lists.h"

#include <algorithm>
#include <charconv>

#include <fmt/ranges.h>

namespace gpu
{

namespace
{

constexpr uint32_t ENOUGH_TEXELS = 1u << 24; // fewer: tables cannot be texel buffers
constexpr uint32_t ENOUGH_TABLES = 16;       // of a stage: likewise; texel buffers count as storage images

// Whatever the device offers, the program stays inside what WebGPU could.
constexpr uint32_t PORTABLE_STORAGE_BUFFERS = 10; // per stage
constexpr uint32_t PORTABLE_INVOCATIONS = 256;    // per workgroup
constexpr uint32_t PORTABLE_SHARED_BYTES = 16384; // per workgroup

const char* kindName(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return "cpu";
    default: return "other";
    }
}

Limits limitsOf(VkPhysicalDevice device, const VkPhysicalDeviceLimits& limits, uint64_t maxAllocation,
                uint32_t timestampBits)
{
    VkPhysicalDeviceMemoryProperties memory = {};
    vkGetPhysicalDeviceMemoryProperties(device, &memory);
    uint64_t heap = 0;
    for (const VkMemoryHeap& h : std::span(memory.memoryHeaps, memory.memoryHeapCount))
        if (h.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) heap = std::max(heap, h.size);

    const uint64_t storage = std::min<uint64_t>(limits.maxStorageBufferRange, maxAllocation);
    return {
        .storageBindingBytes = storage,
        .tableBytes = storage,
        .uniformBindingBytes = limits.maxUniformBufferRange,
        .storageBuffersPerStage = std::min(limits.maxPerStageDescriptorStorageBuffers, PORTABLE_STORAGE_BUFFERS),
        .workgroupInvocations = std::min(limits.maxComputeWorkGroupInvocations, PORTABLE_INVOCATIONS),
        .workgroupBytes = std::min(limits.maxComputeSharedMemorySize, PORTABLE_SHARED_BYTES),
        .memoryBytes = heap,
        .timestamps = timestampBits > 0,
    };
}

bool holdsTexelTables(VkPhysicalDevice device, const VkPhysicalDeviceLimits& limits)
{
    VkFormatProperties format = {};
    vkGetPhysicalDeviceFormatProperties(device, TABLE_FORMAT, &format);
    return limits.maxTexelBufferElements >= ENOUGH_TEXELS &&
           limits.maxPerStageDescriptorStorageImages >= ENOUGH_TABLES &&
           (format.bufferFeatures & VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_BIT) != 0;
}

std::optional<uint32_t> computeFamily(VkPhysicalDevice device, uint32_t& timestampBits)
{
    const auto families = listOf<VkQueueFamilyProperties>(vkGetPhysicalDeviceQueueFamilyProperties, device);
    for (uint32_t i = 0; i < families.size(); ++i) {
        if (!(families[i].queueFlags & VK_QUEUE_COMPUTE_BIT)) continue;
        timestampBits = families[i].timestampValidBits;
        return i;
    }
    return std::nullopt;
}

std::string lowerCase(std::string text)
{
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

} // namespace

std::vector<PhysicalDevice> physicalDevices(VkInstance instance)
{
    uint32_t count = 0;
    vkCheck(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices", "trichrome");
    std::vector<VkPhysicalDevice> handles(count);
    vkCheck(vkEnumeratePhysicalDevices(instance, &count, handles.data()), "vkEnumeratePhysicalDevices", "trichrome");

    std::vector<PhysicalDevice> devices;
    for (VkPhysicalDevice handle : handles) {
        VkPhysicalDeviceProperties basic = {};
        vkGetPhysicalDeviceProperties(handle, &basic);
        if (basic.apiVersion < VK_API_VERSION_1_2) continue;
        PhysicalDevice device = {.handle = handle};
        const std::optional<uint32_t> family = computeFamily(handle, device.timestampBits);
        if (!family) continue;
        device.queueFamily = *family;

        VkPhysicalDeviceVulkan12Properties driver = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES};
        VkPhysicalDeviceVulkan11Properties core11 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES,
                                                     .pNext = &driver};
        VkPhysicalDeviceProperties2 all = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &core11};
        vkGetPhysicalDeviceProperties2(handle, &all);
        device.adapter = {
            .name = basic.deviceName,
            .driver = fmt::format("{} {}", driver.driverName, driver.driverInfo),
            .kind = kindName(basic.deviceType),
            .apiVersion = fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(basic.apiVersion),
                                      VK_API_VERSION_MINOR(basic.apiVersion), VK_API_VERSION_PATCH(basic.apiVersion)),
            .index = uint32_t(devices.size()),
            .limits = limitsOf(handle, basic.limits, core11.maxMemoryAllocationSize, device.timestampBits),
        };
        device.texelBytes =
            std::min<uint64_t>(basic.limits.maxTexelBufferElements * TEXEL_BYTES, core11.maxMemoryAllocationSize);
        device.deviceClass = {
            .cpu = basic.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU,
            .texelTables = holdsTexelTables(handle, basic.limits),
            .subgroupSums = (core11.subgroupSupportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0 &&
                            (core11.subgroupSupportedOperations & VK_SUBGROUP_FEATURE_ARITHMETIC_BIT) != 0,
        };
        tune(device, "");
        devices.push_back(device);
    }
    return devices;
}

void tune(PhysicalDevice& device, const std::string& overrides)
{
    Adapter& adapter = device.adapter;
    adapter.tuning = tuningFor(device.deviceClass);
    applyOverrides(adapter.tuning, overrides);
    requirePossible(adapter.tuning, device.deviceClass, adapter.name);
    const bool texel = adapter.tuning.tables == Tuning::Tables::Texel;
    adapter.limits.tableBytes = texel ? device.texelBytes : adapter.limits.storageBindingBytes;
}

const PhysicalDevice& choose(std::span<const PhysicalDevice> devices, const std::string& wanted)
{
    if (devices.empty())
        throw Error("There is no Vulkan 1.2 device with a compute queue on this machine (a software one is in the "
                    "Debian package mesa-vulkan-drivers).");
    std::vector<std::string> names;
    for (const PhysicalDevice& d : devices) names.push_back(fmt::format("{}: {}", d.adapter.index, d.adapter.name));

    if (wanted.empty()) {
        for (const char* kind : {"discrete", "integrated", "virtual", "cpu"})
            for (const PhysicalDevice& d : devices)
                if (d.adapter.kind == kind) return d;
        return devices.front();
    }

    uint32_t index = 0;
    const auto [end, failure] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    if (failure == std::errc() && end == wanted.data() + wanted.size()) {
        if (index < devices.size()) return devices[index];
    } else {
        for (const PhysicalDevice& d : devices)
            if (lowerCase(d.adapter.name).find(lowerCase(wanted)) != std::string::npos) return d;
    }
    throw Error("There is no Vulkan device \"{}\"; available: {}.", wanted, fmt::join(names, ", "));
}

std::vector<Adapter> enumerateAdapters(const std::string& tuning)
{
    std::vector<PhysicalDevice> devices;
    try {
        const Instance instance(false);
        devices = physicalDevices(instance.handle());
    } catch (const Error&) {
        // No driver: the empty list says so.
    }
    std::vector<Adapter> adapters;
    for (PhysicalDevice& device : devices) {
        tune(device, tuning);
        adapters.push_back(device.adapter);
    }
    return adapters;
}

} // namespace gpu
