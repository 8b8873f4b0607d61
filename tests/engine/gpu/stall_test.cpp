// Work that never ends, and work that takes long.

#include "engine/base/error.h"
#include "engine/gpu/vulkan.h"
#include "shaders/shared/types.h"
#include "tests/support/gpu_fixture.h"

#include <cstdio>
#include <cstdlib>

namespace
{

class Stall : public GpuTest
{
};

// Waits for an endless kernel, as the program would: exits with 1 after the error.
[[noreturn]] void stall(const gpu::DeviceDescriptor& descriptor)
{
    int code = 0;
    try {
        gpu::Device device = gpu::Device::create(descriptor);
        const gpu::Buffer values = device.createBuffer({.label = "values", .size = 16});
        const gpu::ComputePipeline kernel =
            device.createComputePipeline({.label = "endless", .shader = TEST_SPIRV_DIR "/stall_test"});
        const gpu::BindGroup group = device.createBindGroup(
            {.label = "endless", .pipeline = &kernel, .set = SET_PASS, .buffers = {{"Values", &values}}});
        gpu::CommandEncoder encoder = device.createCommandEncoder("frame");
        // lavapipe leaves a loop after 65535 turns; all these workgroups still take a minute.
        encoder.dispatch({.pipeline = &kernel, .groups = {nullptr, nullptr, &group}, .threads = {65535}});
        device.queue().wait(device.queue().submit(std::move(encoder)));
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        code = 1;
    }
    std::exit(code);
}

TEST_F(Stall, IsAnErrorThatNamesTheStageAndTheProgramCanEnd)
{
    if (device().adapter().kind != "cpu") GTEST_SKIP() << "SKIPPED, NOT TESTED: it would hang a graphics card";
    const std::string name = device().adapter().name;
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(stall({.adapter = name, .stallSeconds = 0.25}), testing::ExitedWithCode(1),
                "stalls in \"endless\": nothing was finished for 0.25 s");
}

// Variants of a stage bear its name: how long one takes says nothing about the other.
TEST_F(Stall, WhatAPipelineTakesIsItsOwnWhateverItsLabel)
{
    const gpu::Buffer from = create<uint32_t>("from", 4096), to = create<uint32_t>("to", 4096);
    const gpu::Buffer step = upload("step", std::vector<uint32_t>{7, 11}, gpu::Usage::Uniform);
    const auto dispatch = [&](const gpu::ComputePipeline& kernel) { // how many command buffers it was planned to take
        const gpu::BindGroup frame =
            device().createBindGroup({.label = "frame", .pipeline = &kernel, .set = 0, .buffers = {{"Step", &step}}});
        const gpu::BindGroup pass = device().createBindGroup(
            {.label = "pass", .pipeline = &kernel, .set = SET_PASS, .buffers = {{"From", &from}, {"To", &to}}});
        gpu::CommandEncoder encoder = device().createCommandEncoder("variants");
        encoder.dispatch({.pipeline = &kernel, .groups = {&frame, nullptr, &pass}, .threads = {4096}});
        const size_t count = encoder.state()->commands.size();
        device().queue().wait(device().queue().submit(std::move(encoder)));
        return count;
    };
    const gpu::ComputePipelineDescriptor descriptor = {.label = "variant", .shader = TEST_SPIRV_DIR "/encoder_test"};
    const gpu::ComputePipeline first = device().createComputePipeline(descriptor);
    EXPECT_EQ(dispatch(first), gpu::FIRST_BANDS) << "not known yet";
    EXPECT_EQ(dispatch(first), 1u);
    const gpu::ComputePipeline second = device().createComputePipeline(descriptor);
    EXPECT_EQ(dispatch(second), gpu::FIRST_BANDS) << "the first one's time is not the second's";
    *second.state()->groupMilliseconds = gpu::LONGEST_MILLISECONDS;
    EXPECT_EQ(dispatch(first), 1u);
}

TEST_F(Stall, SlowWorkIsCutIntoCommandBuffersAndGivesTheSame)
{
    using Words = std::vector<uint32_t>;
    const Words input = {7, 11};
    const gpu::Buffer step = upload("step", input, gpu::Usage::Uniform);
    const gpu::ComputePipeline kernel =
        device().createComputePipeline({.label = "slow", .shader = TEST_SPIRV_DIR "/encoder_test"});
    const gpu::BindGroup frame =
        device().createBindGroup({.label = "frame", .pipeline = &kernel, .set = 0, .buffers = {{"Step", &step}}});
    constexpr uint32_t COUNT = 4096;
    Words start(COUNT);
    for (uint32_t i = 0; i < COUNT; ++i) start[i] = i * i;
    const gpu::Buffer from = upload("from", start), to = create<uint32_t>("to", COUNT);
    const gpu::BindGroup pass = device().createBindGroup(
        {.label = "pass", .pipeline = &kernel, .set = SET_PASS, .buffers = {{"From", &from}, {"To", &to}}});
    const auto buffersOf = [&](double groupMilliseconds) {
        *kernel.state()->groupMilliseconds = groupMilliseconds;
        gpu::CommandEncoder encoder = device().createCommandEncoder("slow");
        encoder.clear(to);
        encoder.dispatch({.pipeline = &kernel, .groups = {&frame, nullptr, &pass}, .threads = {COUNT}});
        const size_t count = encoder.state()->commands.size();
        device().queue().submit(std::move(encoder));
        return count;
    };
    EXPECT_EQ(buffersOf(1e-3), 1u);
    const Words once = download<uint32_t>(to);
    EXPECT_NE(once, Words(COUNT, 0));
    const uint32_t groups = (COUNT + kernel.workgroupSize()[0] - 1) / kernel.workgroupSize()[0];
    EXPECT_EQ(buffersOf(gpu::LONGEST_MILLISECONDS * 2), groups); // nothing is smaller than a workgroup
    EXPECT_EQ(download<uint32_t>(to), once);
    EXPECT_EQ(buffersOf(gpu::LONGEST_MILLISECONDS * 3 / groups), 4u); // rounded up to bands of whole groups
    EXPECT_EQ(download<uint32_t>(to), once);
}

} // namespace
