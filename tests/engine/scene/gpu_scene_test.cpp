// Which traversal stack a device gets.

#include "engine/scene/gpu_scene.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace
{

scene::TraversalStack stackFor(gpu::Tuning::Stack stack, uint32_t depth)
{
    gpu::Adapter adapter;
    adapter.tuning.stack = stack;
    scene::BvhStats bvh;
    bvh.depth = depth;
    return scene::traversalStack(adapter, bvh);
}

TEST(TraversalStack, HoldsTheTree)
{
    for (uint32_t depth = 0; depth <= shared::BVH_STACK_SIZE; ++depth) {
        const scene::TraversalStack stack = stackFor(gpu::Tuning::Stack::Array, depth);
        EXPECT_GE(stack.entries, std::max(depth, 1u));
        EXPECT_LT(stack.entries, depth + 5);
        EXPECT_LE(stack.entries, shared::BVH_STACK_SIZE);
    }
}

TEST(TraversalStack, IsInRegistersWhereTheDeviceIsTunedSoAndTheyHoldIt)
{
    using enum gpu::Tuning::Stack;
    EXPECT_TRUE(stackFor(Registers, 9).inRegisters);
    EXPECT_TRUE(stackFor(Registers, 16).inRegisters);
    EXPECT_FALSE(stackFor(Registers, 17).inRegisters); // too many to move
    EXPECT_FALSE(stackFor(Array, 9).inRegisters);
}

} // namespace
