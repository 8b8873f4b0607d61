#include "engine/base/memory.h"

#include <algorithm>
#include <cstdlib> // defines __GLIBC__
#include <fstream>
#include <string>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace memory
{

namespace
{

// The number after `name` in a file of names and numbers; with an empty name, the file's only one.
uint64_t numberIn(const char* file, const std::string& name, uint64_t otherwise)
{
    std::ifstream stream(file);
    uint64_t number = 0;
    for (std::string word = name; name.empty() || stream >> word;)
        if (word == name) return stream >> number ? number : otherwise;
    return otherwise;
}

} // namespace

uint64_t heapBytes()
{
#ifdef __GLIBC__
    const struct mallinfo2 heap = mallinfo2();
    return heap.uordblks + heap.hblkhd;
#else
    return 0;
#endif
}

uint64_t availableBytes()
{
    const uint64_t kilobytes = numberIn("/proc/meminfo", "MemAvailable:", UINT64_MAX >> 10);
    const uint64_t most = numberIn("/sys/fs/cgroup/memory.max", "", UINT64_MAX);
    const uint64_t used = numberIn("/sys/fs/cgroup/memory.current", "", 0);
    const uint64_t cache = numberIn("/sys/fs/cgroup/memory.stat", "inactive_file", 0);
    return std::min(kilobytes << 10, most - std::min(most, used - std::min(used, cache)));
}

void giveBackFreed()
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

} // namespace memory
