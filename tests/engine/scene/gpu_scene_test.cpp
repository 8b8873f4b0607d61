// Which traversal stack a device gets.

#include "engine/scene/gpu_scene.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace
{

gpu::Adapter adapter(const char* kind, bool texelBuffers)
{
    gpu::Adapter adapter;
    adapter.kind = kind;
    adapter.limits.tablesAreTexelBuffers = texelBuffers;
    return adapter;
}

scene::TraversalStack stackFor(const gpu::Adapter& adapter, uint32_t depth)
{
    scene::BvhStats bvh;
    bvh.depth = depth;
    return scene::traversalStack(adapter, bvh);
}

TEST(TraversalStack, HoldsTheTree)
{
    for (uint32_t depth = 0; depth <= shared::BVH_STACK_SIZE; ++depth) {
        const scene::TraversalStack stack = stackFor(adapter("discrete", true), depth);
        EXPECT_GE(stack.entries, std::max(depth, 1u));
        EXPECT_LT(stack.entries, depth + 5);
        EXPECT_LE(stack.entries, shared::BVH_STACK_SIZE);
    }
}

TEST(TraversalStack, IsInRegistersWhereLanesRunUnderMasks)
{
    EXPECT_TRUE(stackFor(adapter("cpu", true), 9).inRegisters);
    EXPECT_TRUE(stackFor(adapter("cpu", true), 16).inRegisters);
    EXPECT_FALSE(stackFor(adapter("cpu", true), 17).inRegisters); // too many to move
    EXPECT_FALSE(stackFor(adapter("cpu", false), 9).inRegisters); // SwiftShader
    EXPECT_FALSE(stackFor(adapter("discrete", true), 9).inRegisters);
}

} // namespace
