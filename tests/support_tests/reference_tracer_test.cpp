#include "tests/support/reference_tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/scene/shapes.h"
#include "tests/support/closed_forms.h"
#include "tests/support/reference_material.h"

namespace support
{
namespace
{

using glm::dvec3;

constexpr double PI = std::numbers::pi;

void expectAgreement(const ClosedForm& form, uint64_t samplesPerPixel, double margin)
{
    const PictureEstimates computed = pictureOf(reference(form.scene, form.settings, samplesPerPixel, 1));
    const TileVerdict verdict = picturesAgree(computed, form.exactly(), margin, 1e-6);
    EXPECT_TRUE(verdict.passes) << form.name << ": " << verdict.summary;
}

TEST(Reference, AgreesWithClosedFormsOfLights)
{
    for (const ClosedForm& form : closedForms(16)) expectAgreement(form, 2000, 0.01);
}

TEST(Reference, FurnaceSumsTheGeometricSeries)
{
    for (const uint32_t depth : {0u, 1u, 3u}) expectAgreement(furnace(8, depth), 400, 0.01);
}

TEST(Reference, GgxKeepsItsAlbedo)
{
    for (const float roughness : {0.2f, 1.0f}) expectAgreement(ggxUnderWhiteSky(8, roughness, 0.3), 4000, 0.01);
}

// With the parameters of the surface under test, on the floor y = 0.
scene::Scene floorOf(const scene::Material& material)
{
    scene::Scene scene;
    scene::addQuad(scene, scene::addMaterial(scene, material), {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    return scene;
}

struct NamedMaterial {
    const char* name;
    scene::Material material;
};
void PrintTo(const NamedMaterial& m, std::ostream* os)
{
    *os << m.name;
}

class ReferenceBsdf : public testing::TestWithParam<NamedMaterial>
{
  protected:
    ReferenceBsdf() : scene_(floorOf(GetParam().material)) {}
    ReferenceSurface seenFrom(const dvec3& wo) const { return {scene_, {0, 0.3, 0.3}, wo}; }
    static dvec3 direction(double cosine, double phi)
    {
        const double sine = std::sqrt(1 - cosine * cosine);
        return {sine * std::cos(phi), cosine, sine * std::sin(phi)};
    }
    // Uniform over the sphere.
    static dvec3 randomDirection(Random& random)
    {
        return direction(2 * uniform(random) - 1, 2 * PI * uniform(random));
    }

    scene::Scene scene_;
    Random random_{7};
};

// The mean weight of samples is the albedo; so is the integral of f cos, taken over uniform directions.
TEST_P(ReferenceBsdf, SamplesHaveTheDensityTheyClaim)
{
    for (const double cosine : {0.9, 0.35, -0.6}) {
        const ReferenceSurface surface = seenFrom(direction(cosine, 0.4));
        Moments sampled, integrated, density;
        for (int i = 0; i < 400000; ++i) {
            const ReferenceSurface::Sample s = surface.sample(random_);
            sampled.add(s.dirac ? 0 : s.weight.x);
            const dvec3 wi = randomDirection(random_);
            integrated.add(4 * PI * surface.evaluate(wi).x * surface.cosine(wi));
            density.add(4 * PI * surface.density(wi));
        }
        const auto deviation = [](const Moments& m) { return std::sqrt(m.varianceOfMean()); };
        EXPECT_NEAR(sampled.mean(), integrated.mean(),
                    4.5 * std::hypot(deviation(sampled), deviation(integrated)) + 1e-9);
        EXPECT_LE(density.mean(), 1 + 4.5 * deviation(density) + 1e-9); // some facets lead nowhere
    }
}

TEST_P(ReferenceBsdf, ReflectsNoMoreThanItReceives)
{
    for (const double cosine : {0.95, 0.5, 0.1, -0.7}) {
        const ReferenceSurface surface = seenFrom(direction(cosine, 1));
        Moments weight;
        for (int i = 0; i < 100000; ++i) weight.add(surface.sample(random_).weight.x);
        EXPECT_LE(weight.mean(), 1 + 4.5 * std::sqrt(weight.varianceOfMean()) + 1e-9) << cosine;
    }
}

TEST_P(ReferenceBsdf, IsReciprocal)
{
    // With eta^2 left out, refraction is reciprocal up to eta^2 (Walter et al. 2007, equation 21); m.ior of solids
    // here.
    const scene::Material& m = GetParam().material;
    const bool solid = m.transmission > 0 && !m.thin;
    for (int i = 0; i < 10000; ++i) {
        const dvec3 wo = randomDirection(random_), wi = randomDirection(random_);
        const double there = seenFrom(wo).evaluate(wi).x, back = seenFrom(wi).evaluate(wo).x;
        double factor = 1;
        if (solid && wo.y * wi.y < 0) factor = wo.y > 0 ? m.ior * double{m.ior} : 1 / (m.ior * double{m.ior});
        EXPECT_NEAR(there, back * factor, 1e-6 * there + 1e-12);
    }
}

std::vector<NamedMaterial> materials()
{
    const glm::vec4 color = {0.8f, 0.5f, 0.3f, 1};
    return {
        {"lambert", {.baseColor = color, .metallic = 0, .roughness = 1, .specular = 0}},
        {"glossy", {.baseColor = color, .metallic = 0, .roughness = 0.6f}},
        {"metal", {.baseColor = color, .metallic = 1, .roughness = 0.5f}},
        {"mixed", {.baseColor = color, .metallic = 0.5f, .roughness = 0.7f, .specular = 0.7f}},
        {"polished", {.baseColor = color, .metallic = 0, .roughness = 0}},
        {"thin", {.baseColor = color, .metallic = 0, .roughness = 0.6f, .transmission = 0.8f}},
        {"glass", {.baseColor = color, .metallic = 0, .roughness = 0.6f, .transmission = 0.8f, .thin = false}},
        {"clear", {.baseColor = color, .metallic = 0, .roughness = 0, .transmission = 1, .thin = false}},
    };
}
INSTANTIATE_TEST_SUITE_P(Of, ReferenceBsdf, testing::ValuesIn(materials()), [](const auto& i) { return i.param.name; });

} // namespace
} // namespace support
