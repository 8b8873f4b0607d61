#include "tests/support/gpu_fixture.h"

#include <numeric>

namespace
{

class Gpu : public GpuTest
{
};

using Words = std::vector<uint32_t>;

TEST_F(Gpu, RunsAKernelOnNamedBuffersWithNamedConstants)
{
    Words values(1000);
    std::iota(values.begin(), values.end(), 0u);
    Words table(4 * values.size());
    for (size_t i = 0; i < values.size(); ++i) table[4 * i] = uint32_t(3 * i);

    const gpu::Buffer buffer = upload("values", values);
    const gpu::Buffer elements = upload("elements", table, gpu::Usage::Table);
    const gpu::Buffer frame = upload("frame", Words{5}, gpu::Usage::Uniform);
    run({.shader = TEST_SPIRV_DIR "/gpu_test",
         .constants = {{"OFFSET", 7}, {"NOT_IN_THE_SHADER", 1}},
         .buffers = {{"Values", &buffer}, {"Elements", &elements}, {"Frame", &frame}},
         .threads = {1000}});
    const Words result = download<uint32_t>(buffer);
    ASSERT_EQ(result.size(), values.size());
    for (uint32_t i = 0; i < 1000; ++i) ASSERT_EQ(result[i], i * 5 + 7 + 3 * i);
}

} // namespace
