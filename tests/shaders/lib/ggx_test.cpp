#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/gpu_fixture.h"

namespace
{

class Ggx : public GpuTest
{
};

TEST_F(Ggx, SchlicksWeightIsAFifthPowerWithinItsBoundsAndHidesNoNan)
{
    const std::vector<float> cosines = {
        0, 0.125f, 0.5f, 0.9375f, 1, std::nextafter(1.0f, 2.0f), 1.5f, -0.5f, std::numeric_limits<float>::quiet_NaN()};
    const gpu::Buffer in = upload("cosines", cosines), out = create<float>("results", cosines.size());
    run({.shader = TEST_SPIRV_DIR "/ggx_test",
         .buffers = {{"Cosines", &in}, {"Results", &out}},
         .threads = {uint32_t(cosines.size())}});
    const std::vector<float> weights = download<float>(out);
    for (size_t i = 0; i < cosines.size(); ++i) {
        if (std::isnan(cosines[i]))
            EXPECT_TRUE(std::isnan(weights[i])) << weights[i];
        else
            EXPECT_FLOAT_EQ(weights[i], std::pow(std::clamp(1 - cosines[i], 0.0f, 1.0f), 5.0f)) << cosines[i];
    }
}

} // namespace
