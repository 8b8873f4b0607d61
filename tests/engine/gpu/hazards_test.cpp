#include "engine/gpu/hazards.h"

#include <gtest/gtest.h>

namespace
{

using Tracker = gpu::HazardTracker<int>;
using Uses = std::vector<gpu::BufferUse<int>>;

constexpr gpu::BufferUse<int> reads(int buffer)
{
    return {buffer, true, false};
}
constexpr gpu::BufferUse<int> writes(int buffer)
{
    return {buffer, false, true};
}

// Whether the last of these pieces of work needs a barrier.
bool lastNeedsBarrier(const std::vector<Uses>& work)
{
    Tracker tracker;
    bool needed = false;
    for (const Uses& uses : work) needed = tracker.needsBarrier(uses);
    return needed;
}

TEST(HazardTracker, OrdersReadAfterWriteWriteAfterReadAndWriteAfterWrite)
{
    EXPECT_TRUE(lastNeedsBarrier({{writes(1)}, {reads(1)}}));
    EXPECT_TRUE(lastNeedsBarrier({{reads(1)}, {writes(1)}}));
    EXPECT_TRUE(lastNeedsBarrier({{writes(1)}, {writes(1)}}));
    EXPECT_TRUE(lastNeedsBarrier({{{1, true, true}}, {{1, true, true}}}));
}

TEST(HazardTracker, LetsIndependentWorkOverlap)
{
    EXPECT_FALSE(lastNeedsBarrier({{writes(1)}}));
    EXPECT_FALSE(lastNeedsBarrier({{reads(1)}, {reads(1)}}));
    EXPECT_FALSE(lastNeedsBarrier({{reads(1), writes(2)}, {reads(1), writes(3)}}));
}

TEST(HazardTracker, RemembersWorkBeforeUnrelatedWork)
{
    EXPECT_TRUE(lastNeedsBarrier({{writes(1)}, {writes(2)}, {reads(3)}, {reads(1)}}));
    EXPECT_TRUE(lastNeedsBarrier({{reads(1), writes(2)}, {reads(3), writes(4)}, {writes(1)}}));
}

TEST(HazardTracker, OneBarrierCoversAllEarlierWork)
{
    // The barrier before {reads(1)} also orders the write of 2, but not what comes after it.
    EXPECT_FALSE(lastNeedsBarrier({{writes(1), writes(2)}, {reads(1)}, {reads(2)}}));
    EXPECT_TRUE(lastNeedsBarrier({{writes(1)}, {reads(1), writes(2)}, {reads(2)}}));
    EXPECT_TRUE(lastNeedsBarrier({{writes(1)}, {reads(1)}, {writes(1)}}));
}

} // namespace
