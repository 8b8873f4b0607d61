// The pool gives back what it has, and forgets what was used least recently.

#include "passes/pipeline_pool.h"

#include "tests/support/gpu_fixture.h"

namespace
{

class PipelinePoolTest : public GpuTest
{
};

TEST_F(PipelinePoolTest, KeepsAsManyAsItSaysAndTheLastUsed)
{
    passes::PipelinePool pool(device());
    const auto variantOf = [](size_t bounces) {
        passes::Variant variant;
        variant.MAX_BOUNCES = uint32_t(bounces);
        return variant;
    };
    const auto get = [&](size_t bounces) { return pool.get("accumulate", variantOf(bounces)).get(); };
    const std::shared_ptr<const gpu::ComputePipeline> used = pool.get("accumulate", variantOf(1));
    for (size_t i = 2; i <= pool.capacity(); ++i) get(i);
    EXPECT_EQ(get(1), used.get());
    EXPECT_EQ(pool.size(), pool.capacity());
    get(pool.capacity() + 1); // 2 goes, which was used least recently
    EXPECT_EQ(get(1), used.get());
    EXPECT_EQ(pool.size(), pool.capacity());
    for (size_t i = 3; i < 3 + pool.capacity(); ++i) get(i); // all others: 1 goes, and lives on here
    EXPECT_NE(get(1), used.get());
    EXPECT_EQ(used->label(), "accumulate");
    EXPECT_EQ(pool.size(), pool.capacity());
}

} // namespace
