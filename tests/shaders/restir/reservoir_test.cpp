// The temporal merge against Eqs. 9 and 13 in double precision, from equal domains to ratios that overflow.

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <glm/glm.hpp>

#include "shaders/shared/frame.h"
#include "tests/support/gpu_fixture.h"

namespace
{

struct Merge {
    float weightSum, historySum, rho, historyRho; // S_n, S_h and the two ratios
    float confidence, historyConfidence, u, carry;
};

class ReservoirTest : public GpuTest
{
  protected:
    std::vector<glm::vec4> merge(const std::vector<Merge>& merges)
    {
        const gpu::Buffer input = upload("Merges", merges), output = create<glm::vec4>("Merged", merges.size());
        run({.shader = TEST_SPIRV_DIR "/reservoir_test",
             .buffers = {{"Merges", &input}, {"Merged", &output}},
             .threads = {uint32_t(merges.size())}});
        return download<glm::vec4>(output);
    }
};

// w_n and w_h of the paper, their targets divided out.
double ownWeight(const Merge& m)
{
    return double(m.weightSum) / (1 + double(m.historyConfidence) / m.confidence * m.rho);
}
double historyWeight(const Merge& m)
{
    if (m.historyRho == 0 || m.historySum == 0) return 0;
    const double share = 1 / (1 / double(m.historyRho) + double(m.confidence) / m.historyConfidence);
    return (double(m.historySum) + m.carry) * share;
}

} // namespace

TEST_F(ReservoirTest, MergesAsInDoublePrecision)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<float> exponent(-90, 90), nearOne(0.5f, 2), unit(0, 1);
    std::vector<Merge> merges;
    for (int i = 0; i < 20000; ++i) {
        const bool wild = i % 2 != 0;
        const auto ratio = [&] { return wild ? std::exp2(exponent(random)) : nearOne(random); };
        merges.push_back({nearOne(random), nearOne(random), ratio(), ratio(), 1,
                          std::exp2(std::floor(20 * unit(random))), unit(random), 1e-8f * unit(random)});
    }
    const std::vector<glm::vec4> merged = merge(merges);
    for (size_t i = 0; i < merges.size(); ++i) {
        const double expected = ownWeight(merges[i]) + historyWeight(merges[i]);
        ASSERT_NEAR(double(merged[i].x) + merged[i].y, expected, 3e-6 * expected) << i;
        ASSERT_NEAR(merged[i].w, ownWeight(merges[i]), 3e-6 * ownWeight(merges[i])) << i;
        const double threshold = ownWeight(merges[i]) / expected; // of keeping the own sample
        if (std::abs(merges[i].u - threshold) < 1e-5) continue;
        EXPECT_EQ(merged[i].z, merges[i].u < threshold ? 0.0f : 1.0f) << i;
    }
}

// Equal domains and a history of 2^20 frames: what one frame adds is below the last bit of the sum, and carried on.
TEST_F(ReservoirTest, CarriesWhatRoundingTook)
{
    const Merge m = {1.3f, 1, 1, 1, 1, 1u << 20, 0.5f, 0};
    const glm::vec4 merged = merge({m}).front();
    const double expected = 1 + (double(1.3f) - 1) / (double(1u << 20) + 1);
    EXPECT_NEAR(double(merged.x) + merged.y, expected, 1e-12);
    EXPECT_GT(std::abs(double(merged.x) - expected), 1e-9); // the sum alone does not hold it
}

// After 2^20 frames the sum is their mean, and the new sample's part, by which weighted color shows it, is what it
// should be.
TEST_F(ReservoirTest, DoesNotDriftInAMillionFrames)
{
    struct Chain {
        uint32_t generator, frames = 0;
        float weightSum = 0, carry = 0, weight = 0, single = 0;
        uint32_t padding[2] = {};
    };
    constexpr uint32_t FRAMES = 1u << 20;
    std::vector<Chain> chains;
    for (uint32_t i = 0; i < 8; ++i) chains.push_back({.generator = 0x9e3779b9u * i});
    const gpu::Buffer buffer = upload("Chains", chains);
    for (uint32_t frame = 0; frame < FRAMES; frame += 32768)
        run({.shader = TEST_SPIRV_DIR "/drift_test",
             .buffers = {{"Chains", &buffer}},
             .threads = {uint32_t(chains.size())}});
    const std::vector<Chain> ends = download<Chain>(buffer);
    for (size_t i = 0; i < chains.size(); ++i) {
        ASSERT_EQ(ends[i].frames, FRAMES);
        uint32_t generator = chains[i].generator;
        double sum = 0, last = 0;
        for (uint32_t frame = 0; frame < FRAMES; ++frame) {
            generator = generator * 1664525u + 1013904223u;
            last = std::ldexp(double(generator >> 8), -23);
            sum += last;
        }
        const double mean = sum / FRAMES;
        EXPECT_EQ(double(ends[i].single), last);
        EXPECT_NEAR(double(ends[i].weightSum) + ends[i].carry, mean, 2e-7 * mean) << i;
        EXPECT_NEAR(ends[i].weight, last / FRAMES, 1e-6 * last / FRAMES) << i;
    }
}

TEST_F(ReservoirTest, StaysFiniteAtTheEnds)
{
    constexpr float INFINITE = std::numeric_limits<float>::infinity(), TINY = 1e-38f, HUGE_SUM = 1e30f;
    std::vector<Merge> merges;
    for (const float own : {0.0f, TINY, 1.0f, HUGE_SUM})
        for (const float history : {0.0f, TINY, 1.0f, HUGE_SUM})
            for (const float rho : {0.0f, TINY, 1.0f, INFINITE})
                for (const float historyRho : {0.0f, TINY, 1.0f, INFINITE})
                    for (const float count : {1.0f, 1048576.0f})
                        merges.push_back({own, history, rho, historyRho, 1, count, 0.25f, 0});
    const std::vector<glm::vec4> merged = merge(merges);
    for (size_t i = 0; i < merges.size(); ++i) {
        EXPECT_TRUE(std::isfinite(merged[i].x) && std::isfinite(merged[i].y)) << i;
        EXPECT_GE(merged[i].x, 0) << i;
        const bool empty = merges[i].historySum == 0 || merges[i].historyRho == 0;
        EXPECT_FALSE(empty && merged[i].z != 0) << "chose nothing, " << i;
    }
}
