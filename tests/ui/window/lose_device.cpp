// Preloaded into the program, this loses what it draws into: when the file that TRICHROME_TEST_LOSE names appears, the
// next pictures of the swapchain are answered with a Vulkan error: as many as the file says, after the error's number.

#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include <dlfcn.h>
#include <unistd.h>

extern "C" int vkAcquireNextImageKHR(void* device, uint64_t swapchain, uint64_t timeout, uint64_t semaphore,
                                     uint64_t fence, uint32_t* index)
{
    static int error = 0, times = 0;
    const char* name = std::getenv("TRICHROME_TEST_LOSE");
    if (std::FILE* file = name ? std::fopen(name, "r") : nullptr) {
        if (std::fscanf(file, "%d %d", &error, &times) != 2) times = 0;
        std::fclose(file);
        unlink(name);
    }
    if (times > 0) {
        --times;
        return error;
    }
    using Acquire = decltype(&vkAcquireNextImageKHR);
    static const auto REAL = reinterpret_cast<Acquire>(dlsym(RTLD_NEXT, "vkAcquireNextImageKHR"));
    return REAL(device, swapchain, timeout, semaphore, fence, index);
}
