#include <random>

#include <glm/glm.hpp>

#include "engine/base/statistics.h"
#include "tests/support/chi_squared.h"
#include "tests/support/gpu_fixture.h"

namespace
{

// Jarzynski and Olano 2020, listing of pcg4d.
glm::uvec4 pcg4d(glm::uvec4 v)
{
    v = v * 1664525u + 1013904223u;
    const auto stir = [&] {
        v.x += v.y * v.w;
        v.y += v.z * v.x;
        v.z += v.x * v.y;
        v.w += v.y * v.z;
    };
    stir();
    v ^= v >> 16u;
    stir();
    return v;
}

class Random : public GpuTest
{
  protected:
    struct Drawn {
        std::vector<glm::uvec4> bits;
        std::vector<float> units;
    };
    Drawn draw(const std::vector<glm::uvec4>& inputs, bool blocks)
    {
        const gpu::Buffer in = upload("inputs", inputs), out = create<glm::uvec4>("outputs", inputs.size()),
                          units = create<float>("units", inputs.size());
        run({.shader = TEST_SPIRV_DIR "/random_test",
             .constants = {{"BLOCKS", blocks}},
             .buffers = {{"Inputs", &in}, {"Outputs", &out}, {"Units", &units}},
             .threads = {uint32_t(inputs.size())}});
        return {download<glm::uvec4>(out), download<float>(units)};
    }

    // Numbers of the pixels of consecutive frames, as a renderer draws them.
    std::vector<glm::uvec4> blocksOf(uint32_t frames, uint32_t pixels, uint32_t block)
    {
        std::vector<glm::uvec4> inputs;
        for (uint32_t frame = 0; frame < frames; ++frame)
            for (uint32_t pixel = 0; pixel < pixels; ++pixel) inputs.emplace_back(frame, pixel, block, 5);
        return draw(inputs, true).bits;
    }
};

double pOfEqualBins(const std::vector<double>& counts)
{
    double sum = 0;
    for (const double count : counts) sum += count;
    const std::vector<double> expected(counts.size(), sum / double(counts.size()));
    return statistics::chiSquaredTest(counts, expected).p;
}

TEST_F(Random, Pcg4dIsThePublishedFunction)
{
    std::vector<glm::uvec4> inputs = {{0, 0, 0, 0}, {1, 2, 3, 4}, glm::uvec4(~0u)};
    std::mt19937 engine(1);
    for (int i = 0; i < 1000; ++i) inputs.emplace_back(engine(), engine(), engine(), engine());
    const std::vector<glm::uvec4> outputs = draw(inputs, false).bits;
    for (size_t i = 0; i < inputs.size(); ++i) EXPECT_EQ(outputs[i], pcg4d(inputs[i])) << i;
}

TEST_F(Random, UnitFloatsAreBelowOne)
{
    const std::vector<float> units = draw({{0, 0, 0, 0}, {~0u, 0, 0, 0}, {0x80000000u, 0, 0, 0}}, false).units;
    EXPECT_EQ(units[0], 0);
    EXPECT_LT(units[1], 1);
    EXPECT_GT(units[1], 0.9999999f);
    EXPECT_EQ(units[2], 0.5f);
}

TEST_F(Random, EachNumberIsUniform)
{
    const std::vector<glm::uvec4> bits = blocksOf(64, 4096, 3);
    for (int c = 0; c < 4; ++c)
        for (const uint32_t shift : {0u, 12u, 24u}) { // of the low, the middle and the high bits
            std::vector<double> counts(256, 0);
            for (const glm::uvec4& b : bits) ++counts[b[c] >> shift & 255];
            EXPECT_GT(pOfEqualBins(counts), 1e-4) << "component " << c << ", bits from " << shift;
        }
}

// Pairs that must not know of each other: of one block, of neighboring pixels, frames and blocks.
TEST_F(Random, PairsAreUniform)
{
    const std::vector<glm::uvec4> bits = blocksOf(64, 4096, 3), next = blocksOf(64, 4096, 4);
    const auto expectUniform = [](const char* what, size_t count, const auto& pair) {
        std::vector<double> counts(1024, 0);
        for (size_t i = 0; i < count; ++i) {
            const auto [a, b] = pair(i);
            ++counts[(a >> 27) * 32 + (b >> 27)];
        }
        EXPECT_GT(pOfEqualBins(counts), 1e-4) << what;
    };
    for (int c = 0; c < 4; ++c) {
        expectUniform("block", bits.size(), [&](size_t i) { return std::pair(bits[i][c], bits[i][(c + 1) % 4]); });
        expectUniform("blocks", bits.size(), [&](size_t i) { return std::pair(bits[i][c], next[i][c]); });
        expectUniform("pixels", bits.size() - 1, [&](size_t i) { return std::pair(bits[i][c], bits[i + 1][c]); });
        expectUniform("frames", bits.size() - 4096, [&](size_t i) { return std::pair(bits[i][c], bits[i + 4096][c]); });
    }
}

} // namespace
