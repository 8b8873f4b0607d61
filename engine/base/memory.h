#pragma once
// Memory: the process's own, as far as the C library tells (glibc), and the system's.

#include <cstdint>

namespace memory
{

uint64_t heapBytes();      // allocated and not freed; 0: not known
uint64_t availableBytes(); // that the system, and the control group, can still give; UINT64_MAX: not known
void giveBackFreed();      // what is freed, and kept for later, goes back to the system; may take a second

} // namespace memory
