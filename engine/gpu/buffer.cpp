// Buffers: one allocation each; the host writes and reads them in place where the memory allows it at full speed.

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/base/memory.h"
#include "engine/gpu/vulkan.h"

#include <algorithm>
#include <cstring>

namespace gpu
{

namespace
{

constexpr uint64_t LEAST_BYTES = 16;

VkBufferUsageFlags vulkanUsage(const DeviceState& device, Usage usage)
{
    VkBufferUsageFlags flags = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    if (has(usage, Usage::Storage)) flags |= VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    if (has(usage, Usage::Uniform)) flags |= VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
    if (has(usage, Usage::Table)) {
        flags |= VK_BUFFER_USAGE_STORAGE_BUFFER_BIT; // stages may write texel buffers so, too (shaders/lib/lanes.glsl)
        if (device.tablesAreTexelBuffers()) flags |= VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;
    }
    return flags;
}

// The first type that the buffer allows and that has all of the flags of one set, sets in order of preference.
uint32_t memoryType(const DeviceState& device, uint32_t allowed,
                    std::initializer_list<VkMemoryPropertyFlags> preferences)
{
    for (const VkMemoryPropertyFlags wanted : preferences)
        for (uint32_t i = 0; i < device.memoryProperties.memoryTypeCount; ++i)
            if ((allowed & (1u << i)) && (device.memoryProperties.memoryTypes[i].propertyFlags & wanted) == wanted)
                return i;
    CHECK(false);
}

constexpr VkMemoryPropertyFlags LOCAL = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
constexpr VkMemoryPropertyFlags HOST = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags CACHED = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

// Device-local memory that the host also sees through its cache is as good as any (CPU drivers, integrated GPUs).
// Uncached host access to a discrete GPU's memory is not: staging is faster.
uint32_t memoryTypeFor(const DeviceState& device, Usage usage, uint32_t allowed)
{
    if (has(usage, Usage::Readback)) return memoryType(device, allowed, {HOST | CACHED, HOST});
    if (device.options.forceStaging) return memoryType(device, allowed, {LOCAL, 0});
    return memoryType(device, allowed, {LOCAL | HOST | CACHED, LOCAL, 0});
}

std::string advice(const BufferDescriptor& descriptor)
{
    return descriptor.setting.empty() ? "" : "; reduce " + descriptor.setting;
}

void checkSize(const DeviceState& device, const BufferDescriptor& descriptor)
{
    const Limits& limits = device.physical.adapter.limits;
    const auto check = [&](Usage usage, uint64_t limit, const char* what) {
        if (!has(descriptor.usage, usage) || descriptor.size <= limit) return;
        throw Error("Buffer \"{}\" needs {} bytes, more than the {} that \"{}\" allows for {}{}.", descriptor.label,
                    descriptor.size, limit, device.physical.adapter.name, what, advice(descriptor));
    };
    check(Usage::Storage, limits.storageBindingBytes, "a storage binding");
    check(Usage::Uniform, limits.uniformBindingBytes, "a uniform binding");
    check(Usage::Table, limits.tableBytes, "a table");
    check(descriptor.usage, limits.memoryBytes, "all memory");
}

void createView(BufferState& state)
{
    const VkBufferViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                         .buffer = state.buffer,
                                         .format = TABLE_FORMAT,
                                         .range = VK_WHOLE_SIZE};
    vkCheck(vkCreateBufferView(state.device->device, &info, nullptr, &state.view), "vkCreateBufferView", state.label);
    state.device->name(VK_OBJECT_TYPE_BUFFER_VIEW, state.view, state.label);
}

} // namespace

std::unique_ptr<BufferState> DeviceState::createBuffer(const BufferDescriptor& descriptor)
{
    retire(); // parked buffers may give their memory back
    auto state = std::make_unique<BufferState>(*this);
    state->label = descriptor.label;
    state->size = descriptor.size;
    state->usage = descriptor.usage;

    const VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
        .size = (std::max(descriptor.size, LEAST_BYTES) + TEXEL_BYTES - 1) / TEXEL_BYTES * TEXEL_BYTES,
        .usage = vulkanUsage(*this, descriptor.usage),
    };
    vkCheck(vkCreateBuffer(device, &info, nullptr, &state->buffer), "vkCreateBuffer", descriptor.label);
    name(VK_OBJECT_TYPE_BUFFER, state->buffer, descriptor.label);

    VkMemoryRequirements needs = {};
    vkGetBufferMemoryRequirements(device, state->buffer, &needs);
    const uint32_t type = memoryTypeFor(*this, descriptor.usage, needs.memoryTypeBits);
    const VkMemoryAllocateInfo allocation = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = needs.size, .memoryTypeIndex = type};
    const auto allocate = [&] {
        // A CPU's driver takes what the system promises, and is killed when it uses what there is not.
        const bool large = needs.size > StagingRing::BYTES; // asking reads some files
        if (large && physical.deviceClass.cpu && needs.size > memory::availableBytes())
            return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        return vkAllocateMemory(device, &allocation, nullptr, &state->memory);
    };
    VkResult result = allocate();
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY && !parked.empty()) { // let go of what is parked, then try again
        wait(submit(nullptr));
        result = allocate();
    }
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY)
        throw Error("Buffer \"{}\" of {} bytes does not fit into the memory of \"{}\", beside {} bytes in use{}.",
                    descriptor.label, descriptor.size, physical.adapter.name, allocatedBytes, advice(descriptor));
    vkCheck(result, "vkAllocateMemory", descriptor.label);
    state->allocated = needs.size;
    allocatedBytes += needs.size;
    name(VK_OBJECT_TYPE_DEVICE_MEMORY, state->memory, descriptor.label);
    vkCheck(vkBindBufferMemory(device, state->buffer, state->memory, 0), "vkBindBufferMemory", descriptor.label);
    if (state->usage != Usage::Readback && has(state->usage, Usage::Table) && tablesAreTexelBuffers())
        createView(*state);

    const bool direct = has(descriptor.usage, Usage::Readback) || !options.forceStaging;
    if (direct && (memoryProperties.memoryTypes[type].propertyFlags & (HOST | CACHED)) == (HOST | CACHED)) {
        void* data = nullptr;
        vkCheck(vkMapMemory(device, state->memory, 0, VK_WHOLE_SIZE, 0, &data), "vkMapMemory", descriptor.label);
        state->mapped = static_cast<std::byte*>(data);
        std::memset(state->mapped, 0, info.size);
    } else {
        writes().fill(*state, 0);
    }
    return state;
}

BufferState::~BufferState()
{
    device->park([vk = device->device, buffer = buffer, memory = memory, view = view] {
        vkDestroyBufferView(vk, view, nullptr);
        vkDestroyBuffer(vk, buffer, nullptr);
        vkFreeMemory(vk, memory, nullptr);
    });
    device->allocatedBytes -= allocated;
}

Buffer Device::createBuffer(const BufferDescriptor& descriptor)
{
    CHECK(!descriptor.label.empty());
    checkSize(*state_, descriptor);
    return Buffer(state_->createBuffer(descriptor));
}

uint64_t Buffer::size() const
{
    return state()->size;
}
const std::string& Buffer::label() const
{
    return state()->label;
}

} // namespace gpu
