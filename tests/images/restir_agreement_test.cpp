// ReSTIR is unbiased: its mean over independent runs is the path tracer's picture, whatever is reused and however.

#include <gtest/gtest.h>

#include "engine/scene/procedural.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/gpu_pictures.h"
#include "tests/support/restir_cases.h"
#include "tests/support/test_scenes.h"

namespace support
{
namespace
{

class RestirAgreement : public GpuTest, public testing::WithParamInterface<RestirCase>
{
};

TEST_P(RestirAgreement, WithThePathTracer)
{
    const TileVerdict verdict = GetParam().verdict(device());
    RecordProperty("verdict", verdict.summary);
    EXPECT_TRUE(verdict.passes) << verdict.summary;
}

INSTANTIATE_TEST_SUITE_P(Of, RestirAgreement, testing::ValuesIn(restirCases()),
                         [](const auto& i) { return i.param.name(); });

} // namespace
} // namespace support
