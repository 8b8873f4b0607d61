#include <cmath>

#include "tests/support/gpu_fixture.h"

namespace
{

class Srgb : public GpuTest
{
};

TEST_F(Srgb, IsDecodedToOneInAMillion)
{
    const gpu::Buffer out = create<float>("results", 256);
    run({.shader = TEST_SPIRV_DIR "/srgb_test", .buffers = {{"Results", &out}}, .threads = {256}});
    const std::vector<float> decoded = download<float>(out);
    for (size_t i = 0; i < decoded.size(); ++i) {
        const double c = double(i) / 255;
        const double expected = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
        EXPECT_NEAR(decoded[i], expected, 1e-6 * expected) << i;
    }
}

} // namespace
