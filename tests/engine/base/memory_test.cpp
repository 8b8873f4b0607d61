#include "engine/base/memory.h"

#include <fstream>
#include <memory>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

namespace
{

double residentBytes()
{
    std::ifstream statm("/proc/self/statm");
    double size = 0, resident = 0;
    statm >> size >> resident;
    return resident * double(sysconf(_SC_PAGESIZE));
}

} // namespace

TEST(Memory, SaysWhatTheSystemCanStillGive)
{
    const uint64_t all = uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGESIZE));
    EXPECT_GT(memory::availableBytes(), 16u << 20);
    EXPECT_LT(memory::availableBytes(), all);
}

// Small blocks between others that stay, so that no allocator gives them back of itself.
TEST(Memory, FreedBlocksAreNoLongerInUseAndGoBackToTheSystem)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
    GTEST_SKIP() << "SKIPPED, NOT TESTED: the allocator is not glibc's";
#endif
    constexpr size_t BLOCK = 4000, BLOCKS = 16384, STAYS = 64; // every 64th stays
    const uint64_t before = memory::heapBytes();
    std::vector<std::unique_ptr<char[]>> blocks;
    for (size_t i = 0; i < BLOCKS; ++i) blocks.push_back(std::make_unique<char[]>(BLOCK));
    const uint64_t full = memory::heapBytes();
    EXPECT_GE(full - before, BLOCK * BLOCKS);
    for (size_t i = 0; i < BLOCKS; ++i)
        if (i % STAYS) blocks[i].reset();
    EXPECT_LE(memory::heapBytes(), full - BLOCK * BLOCKS * 9 / 10);
    const double freed = residentBytes();
    memory::giveBackFreed();
    EXPECT_LT(residentBytes(), freed - double(BLOCK * BLOCKS) / 2);
}
