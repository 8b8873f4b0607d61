// Opening and closing a device, with its pipeline cache.

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/gpu/pipeline_cache.h"
#include "engine/gpu/vulkan.h"
#include "engine/gpu/vulkan_lists.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <unistd.h>

namespace gpu
{

namespace
{

// Whoever offers it wants it enabled (VUID-VkDeviceCreateInfo-pProperties-04451): a device that lacks some of Vulkan.
constexpr const char* PORTABILITY_SUBSET = "VK_KHR_portability_subset"; // the header hides its name with beta features

VkDevice openDevice(const PhysicalDevice& physical, bool robust)
{
    VkPhysicalDeviceVulkan12Features features12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
                                                   .timelineSemaphore = VK_TRUE}; // every Vulkan 1.2 device has it
    const VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                                .pNext = &features12,
                                                .features = {.robustBufferAccess = robust}};
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = physical.queueFamily,
                                           .queueCount = 1,
                                           .pQueuePriorities = &priority};
    const auto offered = listOf<VkExtensionProperties>(vkEnumerateDeviceExtensionProperties, physical.handle, nullptr);
    const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .pNext = &features,
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queue,
                                     .enabledExtensionCount = holds(offered, PORTABILITY_SUBSET) ? 1u : 0u,
                                     .ppEnabledExtensionNames = &PORTABILITY_SUBSET};
    VkDevice device = VK_NULL_HANDLE;
    const VkResult result = vkCreateDevice(physical.handle, &info, nullptr, &device);
    if (result == VK_ERROR_INITIALIZATION_FAILED)
        throw Error("The Vulkan device \"{}\" cannot be opened.", physical.adapter.name);
    vkCheck(result, "vkCreateDevice", physical.adapter.name);
    return device;
}

constexpr uint64_t MAX_CACHE_BYTES = uint64_t{256} << 20;

CacheOwner ownerOf(const VkPhysicalDeviceProperties& properties)
{
    CacheOwner owner = {
        .vendor = properties.vendorID, .device = properties.deviceID, .driverVersion = properties.driverVersion};
    static_assert(sizeof(owner.uuid) == sizeof(properties.pipelineCacheUUID));
    std::memcpy(owner.uuid.data(), properties.pipelineCacheUUID, sizeof(owner.uuid));
    return owner;
}

} // namespace

template <class State>
void Destroy::operator()(State* state) const
{
    delete state;
}
template void Destroy::operator()(BufferState*) const;
template void Destroy::operator()(PipelineState*) const;
template void Destroy::operator()(BindGroupState*) const;
template void Destroy::operator()(EncoderState*) const;
template void Destroy::operator()(DeviceState*) const;

DeviceObject::DeviceObject(DeviceState& owner) : device(&owner)
{
    ++device->liveObjects;
}

DeviceObject::~DeviceObject()
{
    --device->liveObjects;
}

DeviceState::DeviceState(const DeviceDescriptor& wanted, WithoutDevice) : options(wanted), instance(wanted.validation)
{
}

// Delegates, so that the destructor cleans up when opening fails halfway.
DeviceState::DeviceState(const DeviceDescriptor& wanted) : DeviceState(wanted, WithoutDevice())
{
    const std::vector<PhysicalDevice> devices = physicalDevices(instance.handle());
    physical = choose(devices, wanted.adapter);
    tune(physical, wanted.tuning);
    vkGetPhysicalDeviceProperties(physical.handle, &properties);
    vkGetPhysicalDeviceMemoryProperties(physical.handle, &memoryProperties);
    device = openDevice(physical, wanted.validation || wanted.robust);
    vkGetDeviceQueue(device, physical.queueFamily, 0, &vkQueue);

    if (instance.canName()) {
        const auto load = [&]<class Function>(Function& function, const char* symbol) {
            function = reinterpret_cast<Function>(vkGetInstanceProcAddr(instance.handle(), symbol));
        };
        load(setName, "vkSetDebugUtilsObjectNameEXT");
        load(beginLabel, "vkCmdBeginDebugUtilsLabelEXT");
        load(endLabel, "vkCmdEndDebugUtilsLabelEXT");
    }

    const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT |
                                                   VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                          .queueFamilyIndex = physical.queueFamily};
    vkCheck(vkCreateCommandPool(device, &pool, nullptr, &commandPool), "vkCreateCommandPool", "device");
    const VkSemaphoreTypeCreateInfo type = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                            .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
    const VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, .pNext = &type};
    vkCheck(vkCreateSemaphore(device, &semaphore, nullptr, &timeline), "vkCreateSemaphore", "device");
    name(VK_OBJECT_TYPE_SEMAPHORE, timeline, "submissions");
    name(VK_OBJECT_TYPE_QUEUE, vkQueue, "queue");
    name(VK_OBJECT_TYPE_COMMAND_POOL, commandPool, "commands");
    name(VK_OBJECT_TYPE_DEVICE, device, physical.adapter.name);
    loadPipelineCache();
}

DeviceState::~DeviceState()
{
    pendingWrites.reset();
    staging.reset();
    CHECK_EQ(liveObjects.load(), 0u); // every buffer, pipeline and bind group must go before its device
    CHECK_EQ(openEncoders, 0u);
    if (!device) return;
    try {
        if (submitted > 0 && !stalled) wait(submitted); // unlike vkDeviceWaitIdle() not for ever
    } catch (const std::exception&) {
        // A lost device is idle, too.
    }
    if (stalled) {
        instance.abandon();
        // The driver's threads still run, and destructors of its library would take their memory away (SwiftShader
        // crashes).
        on_exit([](int status, void*) { std::fflush(nullptr), _exit(status); }, nullptr);
        return;
    }
    vkDeviceWaitIdle(device);
    try {
        savePipelineCache();
    } catch (const std::exception&) {
        // Only time is lost: the next run compiles again.
    }
    vkDestroyPipelineCache(device, pipelineCache, nullptr);
    for (Parked& object : parked) object.destroy();
    for (const Flight& flight : flights)
        for (VkQueryPool page : flight.timestamps.pages) vkDestroyQueryPool(device, page, nullptr);
    for (VkQueryPool page : freeQueryPages) vkDestroyQueryPool(device, page, nullptr);
    for (const auto& [bindings, layout] : setLayouts) vkDestroyDescriptorSetLayout(device, layout, nullptr);
    vkDestroySemaphore(device, timeline, nullptr);
    vkDestroyCommandPool(device, commandPool, nullptr);
    vkDestroyDevice(device, nullptr);
}

std::filesystem::path DeviceState::cachePath() const
{
    return std::filesystem::path(options.cacheDirectory) /
           fmt::format("pipelines-{:04x}-{:04x}.cache", properties.vendorID, properties.deviceID);
}

void DeviceState::loadPipelineCache()
{
    if (options.cacheDirectory.empty()) return;
    std::optional<std::vector<std::byte>> blob;
    try {
        blob = openCache(ownerOf(properties), files::read(cachePath(), MAX_CACHE_BYTES));
    } catch (const Error&) {
        // No cache yet, or none that can be read: begin anew.
    }
    savedCache = blob.value_or(std::vector<std::byte>{});
    const VkPipelineCacheCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                            .initialDataSize = savedCache.size(),
                                            .pInitialData = savedCache.data()};
    vkCheck(vkCreatePipelineCache(device, &info, nullptr, &pipelineCache), "vkCreatePipelineCache", "pipeline cache");
    name(VK_OBJECT_TYPE_PIPELINE_CACHE, pipelineCache, "pipeline cache");
}

void DeviceState::savePipelineCache()
{
    if (!pipelineCache) return;
    size_t size = 0;
    vkCheck(vkGetPipelineCacheData(device, pipelineCache, &size, nullptr), "vkGetPipelineCacheData", "pipeline cache");
    std::vector<std::byte> blob(size);
    vkCheck(vkGetPipelineCacheData(device, pipelineCache, &size, blob.data()), "vkGetPipelineCacheData",
            "pipeline cache");
    blob.resize(size);
    if (blob == savedCache) return;
    files::createFolder(options.cacheDirectory);
    files::writeAtomically(cachePath(), sealCache(ownerOf(properties), blob));
    savedCache = std::move(blob);
}

void Device::savePipelineCache()
{
    state_->savePipelineCache();
}

void DeviceState::name(VkObjectType type, uint64_t handle, const std::string& label) const
{
    if (!setName) return;
    const VkDebugUtilsObjectNameInfoEXT info = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                                .objectType = type,
                                                .objectHandle = handle,
                                                .pObjectName = label.c_str()};
    setName(device, &info);
}

Device Device::create(const DeviceDescriptor& descriptor)
{
    Device device;
    device.state_.reset(new DeviceState(descriptor));
    return device;
}

const Adapter& Device::adapter() const
{
    return state_->physical.adapter;
}
const Limits& Device::limits() const
{
    return state_->physical.adapter.limits;
}
Queue& Device::queue()
{
    return state_->queue;
}
std::vector<std::string> Device::takeValidationMessages()
{
    return state_->instance.takeMessages();
}
uint64_t Device::allocatedBytes() const
{
    return state_->allocatedBytes;
}

} // namespace gpu
