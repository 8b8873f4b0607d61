// The color estimate beside the reservoirs: its mean over a million frames, and what carries it between materials.

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/glm.hpp>

#include "shaders/shared/frame.h"
#include "tests/support/gpu_fixture.h"

namespace
{

struct Chain {
    glm::vec4 estimate = glm::vec4(0);
    uint32_t generator, frames = 0;
    uint32_t padding[2] = {};
};

class EstimatorTest : public GpuTest
{
  protected:
    void runKernel(const gpu::Buffer& chains, const gpu::Buffer& albedos, const gpu::Buffer& ratios, size_t threads)
    {
        const gpu::Buffer frame = upload("Frame", std::vector<shared::FrameUniform>(1), gpu::Usage::Uniform),
                          counters = create<uint32_t>("Counters", size_t{2} * shared::COUNTER_COUNT);
        run({.shader = TEST_SPIRV_DIR "/estimator_test",
             .buffers = {{"Frame", &frame},
                         {"Counters", &counters},
                         {"Chains", &chains},
                         {"Albedos", &albedos},
                         {"Ratios", &ratios}},
             .threads = {uint32_t(threads)}});
    }

    std::vector<glm::vec4> ratiosOf(const std::vector<glm::vec4>& albedos)
    {
        const gpu::Buffer chains = create<Chain>("Chains", 1), input = upload("Albedos", albedos),
                          ratios = create<glm::vec4>("Ratios", albedos.size() / 2);
        runKernel(chains, input, ratios, albedos.size() / 2);
        return download<glm::vec4>(ratios);
    }
};

} // namespace

// Of frames that are nearly all dark: each of them takes the same few last bits from the mean, and rounding to the
// nearest would always go the same way. (Tried: these eight are off by up to 0.17%.)
TEST_F(EstimatorTest, DoesNotDriftInAMillionFrames)
{
    constexpr uint32_t FRAMES = 1u << 20;
    std::vector<Chain> chains;
    for (uint32_t i = 0; i < 8; ++i) chains.push_back({.generator = 0x9e3779b9u * i});
    const gpu::Buffer buffer = upload("Chains", chains), albedos = create<glm::vec4>("Albedos", 2),
                      ratios = create<glm::vec4>("Ratios", 1);
    for (uint32_t frame = 0; frame < FRAMES; frame += 32768) runKernel(buffer, albedos, ratios, chains.size());
    const std::vector<Chain> ends = download<Chain>(buffer);
    double sum = 0, expected = 0;
    for (size_t i = 0; i < chains.size(); ++i) {
        ASSERT_EQ(ends[i].frames, FRAMES);
        uint32_t generator = chains[i].generator;
        double bright = 0;
        for (uint32_t frame = 0; frame < FRAMES; ++frame) {
            generator = generator * 1664525u + 1013904223u;
            bright += generator >> 26u == 0 ? 64 : 0;
        }
        const double mean = bright / FRAMES;
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(ends[i].estimate[c], mean, 1.5e-4 * mean) << i; // a walk of 10^6 steps of half a last bit
            sum += ends[i].estimate[c];
            expected += mean;
        }
    }
    EXPECT_NEAR(sum, expected, 4e-5 * expected); // and 24 such walks cancel
}

TEST_F(EstimatorTest, CarriesByTheRatioOfAlbedos)
{
    const std::vector<glm::vec4> albedos = {
        {0.37f, 1, 0.002f, 0},  {0.37f, 1, 0.002f, 0},  // equal: 1 to the bit
        {0.8f, 0.1f, 0.3f, 0},  {0.5f, 0.4f, 0.29f, 0}, // brighter, darker
        {1, 0.9f, 0, 0},        {0.01f, 0, 0.5f, 0},    // at most 2; 1 where either is black
        {1.7f, -0.1f, 0.5f, 0}, {1, 0.5f, 0.5f, 0},     // what no albedo should be
    };
    const std::vector<glm::vec4> ratios = ratiosOf(albedos);
    EXPECT_EQ(glm::vec3(ratios[0]), glm::vec3(1));
    EXPECT_NEAR(ratios[1].r, 1.6, 0.01);
    EXPECT_NEAR(ratios[1].g, 0.25, 0.002);
    EXPECT_NEAR(ratios[1].b, 0.3 / 0.29, 0.006);
    EXPECT_EQ(glm::vec3(ratios[2]), glm::vec3(2, 1, 1));
    EXPECT_EQ(glm::vec3(ratios[3]), glm::vec3(1));
}
