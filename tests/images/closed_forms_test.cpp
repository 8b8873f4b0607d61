// The path tracer on the device against formulas.

#include <gtest/gtest.h>

#include "engine/scene/shapes.h"
#include "tests/support/closed_forms.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/gpu_pictures.h"

namespace support
{
namespace
{

class ClosedForms : public GpuTest
{
  protected:
    PictureEstimates render(const ClosedForm& form, uint32_t frames)
    {
        return renderFrames(device(), form.scene, form.settings, frames);
    }
    void expectAgreement(const ClosedForm& form, uint32_t frames, double margin)
    {
        const TileVerdict verdict = picturesAgree(render(form, frames), form.exactly(), margin);
        EXPECT_TRUE(verdict.passes) << form.name << ": " << verdict.summary;
    }
};

TEST_F(ClosedForms, OfLightsHold)
{
    for (const ClosedForm& form : closedForms(32)) expectAgreement(form, 400, 0.01);
}

// From the zenith to the nadir, in skies of few rows and of many; all rows: tests/shaders/scene/sky_test.cpp.
TEST_F(ClosedForms, OfSingleTexelsHold)
{
    for (const uint32_t rows : {64u, 1024u, 4096u})
        for (const uint32_t row : {0u, rows * 2 / 5, rows / 2 - 3, rows - 1}) {
            SCOPED_TRACE(testing::Message() << "row " << row << " of " << rows);
            expectAgreement(texelOfASky(32, 4, rows, row), 256, 0.001);
        }
}

// All methods find all of a small sun's energy.
TEST_F(ClosedForms, OfASunHoldForEveryMethodAndShift)
{
    ClosedForm form = sunInASky(32);
    expectAgreement(form, 400, 0.001);
    using enum passes::Method;
    using enum passes::Shift;
    for (const auto& [method, shift] :
         {std::pair(RestirPt, Hybrid), {RgbRestir, Replay}, {RgbRestir, Reconnection}, {RgbRestir, Hybrid}}) {
        form.settings.method = method;
        form.settings.shift = shift;
        form.settings.frames = 3;
        const TileVerdict verdict =
            picturesAgree(renderRuns(device(), form.scene, form.settings, 128), form.exactly(), 0.002);
        EXPECT_TRUE(verdict.passes) << "method " << int(method) << ", shift " << int(shift) << ": " << verdict.summary;
    }
}

TEST_F(ClosedForms, FurnaceHoldsAtEveryDepth)
{
    for (const uint32_t depth : {0u, 1u, 2u, 5u}) expectAgreement(furnace(96, depth), 40, 0.003);
}

// An albedo that is 0.5% too high in one channel is seen.
TEST_F(ClosedForms, FurnaceOfAnotherAlbedoFails)
{
    ClosedForm form = furnace(96, 5);
    form.scene.materials[0].baseColor.x *= 1.005f;
    EXPECT_FALSE(picturesAgree(render(form, 40), form.exactly(), 0.003).passes);
}

// Energy that single scattering loses is lost, none is gained: the directional albedo of the model itself.
TEST_F(ClosedForms, GgxReflectsItsAlbedo)
{
    for (const float roughness : {0.05f, 0.3f, 0.6f, 1.0f})
        for (const double cosine : {0.95, 0.4, 0.1}) {
            SCOPED_TRACE(testing::Message() << "roughness " << roughness << ", cosine " << cosine);
            expectAgreement(ggxUnderWhiteSky(32, roughness, cosine), 200, 0.01);
        }
}

// A closed body of clear glass under a white sky is as bright as the sky (docs/LIGHT_TRANSPORT.md: eta^2 is left out).
TEST_F(ClosedForms, ClearGlassUnderAWhiteSkyIsInvisible)
{
    ClosedForm form = ggxUnderWhiteSky(32, 0, 0.5);
    scene::Material& glass = form.scene.materials[0];
    glass = {.baseColor = {1, 1, 1, 1}, .metallic = 0, .roughness = 0, .transmission = 1, .thin = false};
    form.scene.positions.clear();
    form.scene.normals.clear();
    form.scene.triangles.clear();
    scene::addSphere(form.scene, 0, {0, 0, 0}, 1, 2);
    form.scene.cameras[0].ymag = 1.2;
    form.settings.maxBounces = 40;
    form.radiance = [](double, double) { return glm::dvec3(1); };
    expectAgreement(form, 100, 0.005);
}

} // namespace
} // namespace support
