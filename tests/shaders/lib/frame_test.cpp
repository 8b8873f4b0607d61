// Counters in each of their forms, and what counts as finite.

#include <algorithm>
#include <bit>
#include <cstdio>
#include <limits>
#include <random>

#include <glm/glm.hpp>

#include "engine/base/error.h"
#include "shaders/shared/frame.h"
#include "shaders/shared/tuning.h"
#include "tests/support/gpu_fixture.h"

namespace
{

using Counts = std::vector<uint64_t>;

class FrameLib : public GpuTest
{
  protected:
    // Counts from `start` on, in each low and high word alike.
    Counts count(uint32_t form, const std::vector<uint32_t>& amounts, const std::vector<glm::vec4>& values,
                 uint64_t start)
    {
        std::vector<uint32_t> words;
        for (uint32_t i = 0; i < shared::COUNTER_COUNT; ++i) {
            words.push_back(uint32_t(start));
            words.push_back(uint32_t(start >> 32));
        }
        const gpu::Buffer counters = upload("counters", words);
        const gpu::Buffer frame = create<shared::FrameUniform>("frame", 1, gpu::Usage::Uniform);
        const gpu::Buffer in = upload("amounts", amounts), of = upload("values", values);
        const gpu::Buffer out = create<glm::vec4>("results", values.size());
        run({.shader = TEST_SPIRV_DIR "/frame_test",
             .constants = {{"COUNTERS", form}},
             .buffers =
                 {{"Frame", &frame}, {"Counters", &counters}, {"Amounts", &in}, {"Values", &of}, {"Results", &out}},
             .threads = {uint32_t(amounts.size())}});
        results = download<glm::vec4>(out);
        words = download<uint32_t>(counters);
        Counts counts;
        for (uint32_t i = 0; i < shared::COUNTER_COUNT; ++i)
            counts.push_back((uint64_t{words[2 * i]} | uint64_t{words[2 * i + 1]} << 32) - start);
        return counts;
    }

    // Have the device's compute shaders subgroup arithmetic?
    static bool sumsSubgroups()
    {
        try {
            openDevice({.tuning = "counters=subgroup"});
            return true;
        } catch (const Error&) {
            return false;
        }
    }

    std::vector<glm::vec4> results;
};

TEST_F(FrameLib, CountersAreExactInEachForm)
{
    constexpr uint32_t COUNT = 3 * 64 + 21;
    std::mt19937 engine(7);
    std::vector<uint32_t> amounts(COUNT);
    for (uint32_t& amount : amounts) amount = uint32_t(engine() % 1000);
    std::fill(amounts.begin() + 40, amounts.begin() + 60, 0u);
    std::vector<glm::vec4> values(COUNT, glm::vec4(1));
    for (uint32_t i = 0; i < COUNT; i += 9) values[i].y = std::numeric_limits<float>::infinity();

    Counts expected(shared::COUNTER_COUNT);
    for (const uint32_t amount : amounts) {
        expected[0] += amount;
        if (amount % 3 == 0) expected[1] += amount;
        if (amount % 3 != 0) ++expected[2];
        for (uint32_t round = 0; round < amount % 7; ++round) expected[3] += round;
        if (amount % 5 != 1) expected[4] += amount % 2;
    }
    const uint32_t notFinite = shared::COUNTER_NONFINITE + shared::STAGE_TEMPORAL;
    expected[notFinite] = (COUNT + 8) / 9;
    const bool sums = sumsSubgroups();
    if (!sums) std::printf("SKIPPED, NOT TESTED: sums of subgroups, which this device lacks\n");
    // Also where the low word overflows on the way.
    for (const uint64_t start : {uint64_t{0}, uint64_t{0xffffff80}, uint64_t{0x5'ffff'0000}}) {
        EXPECT_EQ(count(shared::COUNTERS_EACH, amounts, values, start), expected) << start;
        if (!sums) continue;
        EXPECT_EQ(count(shared::COUNTERS_SUBGROUP, amounts, values, start), expected) << start;
    }
    Counts onlyNotFinite(shared::COUNTER_COUNT);
    onlyNotFinite[notFinite] = expected[notFinite];
    EXPECT_EQ(count(shared::COUNTERS_OFF, amounts, values, 0), onlyNotFinite);
}

// By bits: infinities and every kind of NaN are found wherever they stand; the largest, the smallest and zeros are not.
TEST_F(FrameLib, OnlyInfinitiesAndNansAreNotFinite)
{
    const std::vector<uint32_t> bad = {0x7f800000u, 0xff800000u, 0x7fc00000u, 0xffc00000u,
                                       0x7f800001u, 0xff800001u, 0x7fffffffu, 0xffffffffu};
    const std::vector<uint32_t> good = {0x7f7fffffu, 0xff7fffffu, 0u,         0x80000000u,
                                        0x00800000u, 0x3f800000u, 0xc2f60000u};
    std::vector<glm::vec4> values;
    std::vector<bool> finite;
    for (const auto* list : {&bad, &good})
        for (const uint32_t bits : *list)
            for (int at = 0; at < 3; ++at) {
                values.emplace_back(1.0f, 2.0f, 3.0f, 0.0f);
                values.back()[at] = std::bit_cast<float>(bits);
                finite.push_back(list == &good);
            }
    const Counts counts = count(shared::COUNTERS_EACH, std::vector<uint32_t>(values.size()), values, 0);
    EXPECT_EQ(counts[shared::COUNTER_NONFINITE + shared::STAGE_TEMPORAL], 3 * bad.size());
    ASSERT_EQ(results.size(), values.size());
    for (size_t i = 0; i < values.size(); ++i)
        for (int at = 0; at < 3; ++at)
            EXPECT_EQ(std::bit_cast<uint32_t>(results[i][at]), finite[i] ? std::bit_cast<uint32_t>(values[i][at]) : 0u)
                << i;
}

} // namespace
