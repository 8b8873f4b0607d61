// The world's refusals on demand: every call below goes through here in the executable trichrome_faulty, which is
// trichrome but for that (the linker's --wrap, from this very list: CMakeLists.txt). So the product holds no seam.
//
//     TRICHROME_FAULT=vkAllocateMemory:3:-2    the third call fails, with VK_ERROR_OUT_OF_DEVICE_MEMORY
//     TRICHROME_FAULT=write:1:28               the first write is short, the next one fails, with ENOSPC
//     TRICHROME_CALLS=FILE                     how often each was called is written there at the end

#include <fcntl.h>
#include <unistd.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

namespace
{

constexpr int MAX_CALLS = 64;

struct Call {
    const char* name = nullptr;
    std::atomic<long> count = 0;
};
Call calls[MAX_CALLS];
std::atomic<int> callCount = 0;

struct Plan {
    char name[64] = "";
    long number = 0;
    int code = 0;

    Plan()
    {
        const char* text = std::getenv("TRICHROME_FAULT");
        if (text && std::sscanf(text, "%63[^:]:%ld:%d", name, &number, &code) != 3) std::abort();
    }
};
const Plan& plan()
{
    static const Plan instance;
    return instance;
}

extern "C" std::FILE* __real_fopen(const char* path, const char* mode);

void writeCounts()
{
    const char* path = std::getenv("TRICHROME_CALLS");
    if (!path) return;
    std::FILE* file = __real_fopen(path, "w");
    for (int i = 0; i < callCount; ++i) std::fprintf(file, "%s %ld\n", calls[i].name, calls[i].count.load());
    std::fclose(file);
}

Call* enroll(const char* name)
{
    if (callCount == 0) std::atexit(writeCounts);
    Call& call = calls[callCount++]; // no allocation: operator new is one of the calls
    call.name = name;
    return &call;
}

std::atomic<bool> inMain = false; // before and after, nobody could catch

bool fails(Call& call)
{
    return inMain && ++call.count == plan().number && std::strcmp(plan().name, call.name) == 0;
}

int failure()
{
    errno = plan().code;
    return -1;
}

} // namespace

extern "C" int __real_main(int argc, char** argv);
extern "C" int __wrap_main(int argc, char** argv)
{
    inMain = true;
    const int code = __real_main(argc, argv);
    inMain = false;
    return code;
}

// Not parenthesised: types and lists of parameters. NOLINTBEGIN(bugprone-macro-parentheses)
#define FAULTY(name, type, failed, parameters, arguments)                                                              \
    extern "C" type __real_##name parameters;                                                                          \
    extern "C" type __wrap_##name parameters                                                                           \
    {                                                                                                                  \
        static Call* const call = enroll(#name);                                                                       \
        return fails(*call) ? failed : __real_##name arguments;                                                        \
    }
#define FAULTY_VK(name, parameters, arguments) FAULTY(name, VkResult, VkResult(plan().code), parameters, arguments)
// The common kind: makes an object of a device.
#define FAULTY_CREATE(name, Info, Handle)                                                                              \
    FAULTY_VK(name, (VkDevice d, const Info* i, const VkAllocationCallbacks* a, Handle* h), (d, i, a, h))
// NOLINTEND(bugprone-macro-parentheses)

// clang-format off
FAULTY_VK(vkCreateInstance, (const VkInstanceCreateInfo* i, const VkAllocationCallbacks* a, VkInstance* h), (i, a, h))
FAULTY_VK(vkEnumeratePhysicalDevices, (VkInstance i, uint32_t* n, VkPhysicalDevice* h), (i, n, h))
FAULTY_VK(vkCreateDevice, (VkPhysicalDevice p, const VkDeviceCreateInfo* i, const VkAllocationCallbacks* a, VkDevice* h), (p, i, a, h))
FAULTY_CREATE(vkCreateCommandPool, VkCommandPoolCreateInfo, VkCommandPool)
FAULTY_CREATE(vkCreateSemaphore, VkSemaphoreCreateInfo, VkSemaphore)
FAULTY_CREATE(vkCreatePipelineCache, VkPipelineCacheCreateInfo, VkPipelineCache)
FAULTY_VK(vkGetPipelineCacheData, (VkDevice d, VkPipelineCache c, size_t* n, void* p), (d, c, n, p))
FAULTY_CREATE(vkCreateBuffer, VkBufferCreateInfo, VkBuffer)
FAULTY_CREATE(vkCreateBufferView, VkBufferViewCreateInfo, VkBufferView)
FAULTY_CREATE(vkAllocateMemory, VkMemoryAllocateInfo, VkDeviceMemory)
FAULTY_VK(vkBindBufferMemory, (VkDevice d, VkBuffer b, VkDeviceMemory m, VkDeviceSize o), (d, b, m, o))
FAULTY_VK(vkMapMemory, (VkDevice d, VkDeviceMemory m, VkDeviceSize o, VkDeviceSize n, VkMemoryMapFlags f, void** p), (d, m, o, n, f, p))
FAULTY_CREATE(vkCreateShaderModule, VkShaderModuleCreateInfo, VkShaderModule)
FAULTY_CREATE(vkCreateDescriptorSetLayout, VkDescriptorSetLayoutCreateInfo, VkDescriptorSetLayout)
FAULTY_CREATE(vkCreatePipelineLayout, VkPipelineLayoutCreateInfo, VkPipelineLayout)
FAULTY_VK(vkCreateComputePipelines, (VkDevice d, VkPipelineCache c, uint32_t n, const VkComputePipelineCreateInfo* i, const VkAllocationCallbacks* a, VkPipeline* h), (d, c, n, i, a, h))
FAULTY_CREATE(vkCreateDescriptorPool, VkDescriptorPoolCreateInfo, VkDescriptorPool)
FAULTY_VK(vkAllocateDescriptorSets, (VkDevice d, const VkDescriptorSetAllocateInfo* i, VkDescriptorSet* h), (d, i, h))
FAULTY_CREATE(vkCreateQueryPool, VkQueryPoolCreateInfo, VkQueryPool)
FAULTY_VK(vkAllocateCommandBuffers, (VkDevice d, const VkCommandBufferAllocateInfo* i, VkCommandBuffer* h), (d, i, h))
FAULTY_VK(vkBeginCommandBuffer, (VkCommandBuffer c, const VkCommandBufferBeginInfo* i), (c, i))
FAULTY_VK(vkEndCommandBuffer, (VkCommandBuffer c), (c))
FAULTY_VK(vkQueueSubmit, (VkQueue q, uint32_t n, const VkSubmitInfo* i, VkFence f), (q, n, i, f))
FAULTY_VK(vkGetSemaphoreCounterValue, (VkDevice d, VkSemaphore s, uint64_t* v), (d, s, v))
FAULTY_VK(vkWaitSemaphores, (VkDevice d, const VkSemaphoreWaitInfo* i, uint64_t t), (d, i, t))
FAULTY_VK(vkGetQueryPoolResults, (VkDevice d, VkQueryPool p, uint32_t f, uint32_t n, size_t s, void* r, VkDeviceSize e, VkQueryResultFlags g), (d, p, f, n, s, r, e, g))

FAULTY(fopen, std::FILE*, (failure(), nullptr), (const char* path, const char* mode), (path, mode))
FAULTY(fread, size_t, (failure(), 0), (void* to, size_t size, size_t count, std::FILE* file), (to, size, count, file))
FAULTY(fsync, int, failure(), (int descriptor), (descriptor))
FAULTY(linkat, int, failure(), (int a, const char* from, int b, const char* to, int flags), (a, from, b, to, flags))
FAULTY(rename, int, failure(), (const char* from, const char* to), (from, to))
FAULTY(_Znwm, void*, throw std::bad_alloc(), (size_t size), (size))
FAULTY(_ZN6memory14availableBytesEv, uint64_t, 0, (), ()) // memory::availableBytes()
// clang-format on

extern "C" int __real_open(const char* path, int flags, mode_t mode);
extern "C" int __wrap_open(const char* path, int flags, mode_t mode)
{
    static Call* const call = enroll("open");
    return fails(*call) ? failure() : __real_open(path, flags, mode);
}

// Half of it the first time, as on a disk that is nearly full.
extern "C" ssize_t __real_write(int descriptor, const void* bytes, size_t size);
extern "C" ssize_t __wrap_write(int descriptor, const void* bytes, size_t size)
{
    static Call* const call = enroll("write");
    static std::atomic<bool> full = false;
    if (full) return failure();
    full = fails(*call);
    return __real_write(descriptor, bytes, full ? (size + 1) / 2 : size);
}
