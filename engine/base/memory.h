#pragma once
// The process's own memory, as far as the C library tells: glibc.

#include <cstdint>

namespace memory
{

uint64_t heapBytes(); // allocated and not freed; 0: not known
void giveBackFreed(); // what is freed, and kept for later, goes back to the system; may take a second

} // namespace memory
