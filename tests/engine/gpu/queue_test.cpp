// Uploads, submissions in flight, readback, timings; with memory that the host sees and with forced staging.

#include "engine/base/clock.h"
#include "engine/base/error.h"
#include "engine/gpu/vulkan.h"
#include "tests/support/gpu_fixture.h"

#include <numeric>

namespace
{

using Words = std::vector<uint32_t>;

class Queue : public GpuTest, public testing::WithParamInterface<bool>
{
  protected:
    void SetUp() override
    {
        GpuTest::SetUp();
        if (IsSkipped()) return;
        device_ = openDevice({.forceStaging = GetParam()});
        appendKernel_ = device_->createComputePipeline({.label = "append", .shader = TEST_SPIRV_DIR "/queue_test"});
    }
    void TearDown() override
    {
        if (!device_) return;
        for (const std::string& message : device_->takeValidationMessages()) ADD_FAILURE() << message;
        GpuTest::TearDown();
    }

    gpu::Queue& queue() { return device_->queue(); }
    gpu::Buffer buffer(const std::string& label, uint64_t words, gpu::Usage usage = gpu::Usage::Storage)
    {
        return device_->createBuffer({.label = label, .size = words * sizeof(uint32_t), .usage = usage});
    }
    void write(const gpu::Buffer& target, const Words& values, uint64_t offsetWords = 0)
    {
        queue().write(target, std::as_bytes(std::span(values)), offsetWords * sizeof(uint32_t));
    }
    gpu::BindGroup group(const gpu::Buffer& entry, const gpu::Buffer& log)
    {
        return device_->createBindGroup(
            {.label = "append", .pipeline = &appendKernel_, .set = 2, .buffers = {{"Entry", &entry}, {"Log", &log}}});
    }
    gpu::Submission append(const gpu::BindGroup& entryAndLog, int times = 1, const std::string& label = "")
    {
        gpu::CommandEncoder encoder = device_->createCommandEncoder("append");
        for (int i = 0; i < times; ++i)
            encoder.dispatch({.pipeline = &appendKernel_, .groups = {nullptr, nullptr, &entryAndLog}, .label = label});
        return queue().submit(std::move(encoder));
    }

    std::optional<gpu::Device> device_;
    gpu::ComputePipeline appendKernel_; // goes before the device
};

TEST_P(Queue, WritesAndReadsBackAtAnyOffset)
{
    const gpu::Buffer target = buffer("target", 1000);
    Words expected(1000, 0);
    uint32_t value = 1;
    for (const auto& [offset, count] :
         {std::pair(0u, 1000u), std::pair(3u, 5u), std::pair(999u, 1u), std::pair(4u, 9u)}) {
        const Words piece(count, value++);
        write(target, piece, offset);
        std::ranges::copy(piece, expected.begin() + offset);
    }
    EXPECT_EQ(queue().readAs<uint32_t>(target), expected);
}

TEST_P(Queue, WritesMoreThanTheStagingRingHolds)
{
    const uint64_t count = 3 * gpu::StagingRing::BYTES / sizeof(uint32_t) + 5;
    const gpu::Buffer target = buffer("large", count);
    Words values(count);
    std::iota(values.begin(), values.end(), 1u);
    write(target, values);
    write(target, Words{7, 7}, 1000);
    values[1000] = values[1001] = 7;
    EXPECT_TRUE(queue().readAs<uint32_t>(target) == values);
}

TEST_P(Queue, AWriteTakesEffectBetweenTheSubmissionsAroundIt)
{
    constexpr uint32_t COUNT = 200;
    const gpu::Buffer entry = buffer("entry", 4, gpu::Usage::Uniform);
    const gpu::Buffer log = buffer("log", COUNT);
    const gpu::BindGroup entryAndLog = group(entry, log);
    Words expected(COUNT);
    for (uint32_t i = 0; i < COUNT; ++i) {
        write(entry, {i, 0});         // overwritten before it is seen
        write(entry, {i, i * i + 1}); // nobody waits for anybody here
        append(entryAndLog);
        expected[i] = i * i + 1;
    }
    EXPECT_EQ(queue().readAs<uint32_t>(log), expected);
}

TEST_P(Queue, SubmissionsGrowAndAreDoneAfterWaiting)
{
    const gpu::Buffer entry = buffer("entry", 4, gpu::Usage::Uniform);
    const gpu::Buffer log = buffer("log", 4);
    const gpu::BindGroup entryAndLog = group(entry, log);
    const gpu::Submission first = append(entryAndLog);
    const gpu::Submission second = append(entryAndLog);
    EXPECT_GT(first, 0u);
    EXPECT_GT(second, first);
    EXPECT_TRUE(queue().done(0));
    queue().wait(second);
    EXPECT_TRUE(queue().done(first));
    EXPECT_TRUE(queue().done(second));
    EXPECT_FALSE(queue().done(second + 1));
}

TEST_P(Queue, KeepsAliveWhatIsDestroyedInFlight)
{
    constexpr uint32_t COUNT = 50;
    const gpu::Buffer log = buffer("log", COUNT);
    const uint64_t before = device_->allocatedBytes();
    gpu::ComputePipeline shortLived =
        device_->createComputePipeline({.label = "short-lived", .shader = TEST_SPIRV_DIR "/queue_test"});
    for (uint32_t i = 0; i < COUNT; ++i) {
        const gpu::Buffer entry = buffer("short-lived", 4, gpu::Usage::Uniform);
        write(entry, {i, i + 1});
        const gpu::BindGroup entryAndLog = group(entry, log);
        append(entryAndLog);
    } // each goes while its submission may still run
    {
        gpu::CommandEncoder encoder = device_->createCommandEncoder("destroyed before submit");
        {
            const gpu::Buffer entry = buffer("gone", 4, gpu::Usage::Uniform);
            write(entry, {0, 1000});
            const gpu::BindGroup entryAndLog = group(entry, log);
            encoder.dispatch({.pipeline = &shortLived, .groups = {nullptr, nullptr, &entryAndLog}});
            shortLived = {};
        }
        queue().submit(std::move(encoder));
    }
    Words expected(COUNT);
    std::iota(expected.begin(), expected.end(), 1u);
    expected[0] = 1000;
    EXPECT_EQ(queue().readAs<uint32_t>(log), expected);
    // Staging memory, made at the first write, stays; everything else has gone for good.
    EXPECT_LE(device_->allocatedBytes(), before + gpu::StagingRing::BYTES);
    EXPECT_TRUE(device_->state().parked.empty());
}

TEST_P(Queue, ReadLaterSeesTheBufferAsItWasThen)
{
    const gpu::Buffer target = buffer("target", 4);
    write(target, {1, 2, 3, 4});
    const gpu::Queue::Readback early = queue().readLater(target);
    write(target, {5, 6, 7, 8});
    const gpu::Queue::Readback late = queue().readLater(target);
    EXPECT_LT(early.submission, late.submission);
    const auto words = [&](const gpu::Queue::Readback& readback) {
        const std::vector<std::byte> bytes = queue().take(readback);
        Words values(bytes.size() / 4);
        std::memcpy(values.data(), bytes.data(), bytes.size());
        return values;
    };
    EXPECT_EQ(words(late), (Words{5, 6, 7, 8}));
    EXPECT_EQ(words(early), (Words{1, 2, 3, 4}));
}

TEST_P(Queue, TimesEveryLabelOnceASubmission)
{
    if (!device_->limits().timestamps) GTEST_SKIP() << "SKIPPED, NOT TESTED: the device has no timestamps";
    const gpu::Buffer entry = buffer("entry", 4, gpu::Usage::Uniform);
    const gpu::Buffer log = buffer("log", 4);
    const gpu::BindGroup entryAndLog = group(entry, log);
    queue().wait(append(entryAndLog)); // compiles

    const auto start = Clock::now();
    const gpu::Submission first = append(entryAndLog, 150, "many"); // more than a page of timestamps
    append(entryAndLog);
    const gpu::Submission last = append(entryAndLog, 2);
    queue().wait(last);
    const double wall = 1000 * secondsSince(start);

    std::vector<gpu::Timing> timings;
    for (gpu::Submission submission = first; submission <= last; ++submission) {
        const std::vector<gpu::Timing> own = queue().takeTimings(submission);
        ASSERT_EQ(own.size(), 1u);
        EXPECT_EQ(own[0].label, submission == first ? "many" : "append");
        timings.push_back(own[0]);
        EXPECT_TRUE(queue().takeTimings(submission).empty());
    }
    double sum = 0;
    for (const gpu::Timing& timing : timings) {
        EXPECT_GT(timing.milliseconds, 0);
        sum += timing.milliseconds;
    }
    EXPECT_LT(sum, wall);
    EXPECT_GT(timings[0].milliseconds, timings[1].milliseconds);
}

TEST_P(Queue, ALostDeviceIsAnError)
{
    const gpu::Buffer entry = buffer("entry", 4, gpu::Usage::Uniform);
    const gpu::Buffer log = buffer("log", 4);
    const gpu::BindGroup entryAndLog = group(entry, log);
    const gpu::Submission before = append(entryAndLog);
    const auto sentence = [](auto&& work) -> std::string {
        try {
            work();
        } catch (const Error& error) {
            return error.what();
        }
        return "no error";
    };

    device_->state().waitSemaphores = [](VkDevice, const VkSemaphoreWaitInfo*, uint64_t) {
        return VK_ERROR_DEVICE_LOST;
    };
    EXPECT_NE(sentence([&] { queue().wait(before); }).find("was lost in vkWaitSemaphores"), std::string::npos);
    device_->state().queueSubmit = [](VkQueue, uint32_t, const VkSubmitInfo*, VkFence) { return VK_ERROR_DEVICE_LOST; };
    EXPECT_NE(sentence([&] { append(entryAndLog); }).find("was lost in vkQueueSubmit (\"append\")"), std::string::npos);
    EXPECT_NE(sentence([&] { queue().read(log); }).find("lost"), std::string::npos);
} // and everything can still be destroyed

INSTANTIATE_TEST_SUITE_P(Memory, Queue, testing::Bool(),
                         [](const auto& memory) { return memory.param ? "Staged" : "Direct"; });

TEST(StagingRing, GivesOutDisjointPiecesAndWrapsAround)
{
    constexpr uint64_t THIRD = gpu::StagingRing::BYTES / 3;
    gpu::StagingRing ring;
    EXPECT_EQ(ring.allocate(THIRD), 0u);
    EXPECT_EQ(ring.allocate(THIRD), THIRD);
    EXPECT_EQ(ring.allocate(2 * THIRD), std::nullopt); // does not fit
    ring.tail = THIRD;                                 // the first has been consumed
    EXPECT_EQ(ring.allocate(THIRD), 2 * THIRD);
    EXPECT_EQ(ring.allocate(THIRD), 0u);           // the next lap
    EXPECT_EQ(ring.allocate(THIRD), std::nullopt); // full
    ring.tail = ring.head;
    EXPECT_TRUE(ring.allocate(gpu::StagingRing::BYTES - THIRD));
}

} // namespace
