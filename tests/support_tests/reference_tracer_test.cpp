#include "tests/support/reference_tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/scene/procedural.h"
#include "engine/scene/shapes.h"
#include "tests/support/reference_material.h"

namespace support
{
namespace
{

using glm::dvec3;

constexpr double PI = std::numbers::pi;

passes::Settings small(uint32_t size, uint32_t maxBounces)
{
    passes::Settings settings;
    settings.width = settings.height = size;
    settings.maxBounces = maxBounces;
    return settings;
}

// Every pixel within 4.5 standard errors of a known value; where there is no variance, within rounding.
void expectPixels(const PixelEstimates& picture, const std::function<dvec3(uint32_t x, uint32_t y)>& expected)
{
    for (uint32_t i = 0; i < picture.pixels.size(); ++i) {
        const dvec3 truth = expected(i % picture.width, i / picture.width);
        for (int c = 0; c < 3; ++c) {
            const Estimate& e = picture.pixels[i][static_cast<size_t>(c)];
            EXPECT_NEAR(e.mean, truth[c], 4.5 * std::sqrt(e.varianceOfMean) + 1e-6 * truth[c])
                << "pixel " << i << " channel " << c;
        }
    }
}

// Looks straight down on the floor y = 0 from height 1; pixel (x, y) of a size x size picture sees this point of it.
scene::Scene floorSeenFromAbove(const scene::Material& material)
{
    scene::Scene scene;
    scene::addQuad(scene, scene::addMaterial(scene, material), {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    scene::Camera camera;
    camera.position = {0, 1, 0};
    camera.right = {1, 0, 0};
    camera.up = {0, 0, -1};
    camera.forward = {0, -1, 0};
    camera.yfov = PI / 2;
    scene.cameras.push_back(camera);
    return scene;
}
dvec3 seenPoint(uint32_t x, uint32_t y, uint32_t size)
{
    return {2 * (x + 0.5) / size - 1, 0, 2 * (y + 0.5) / size - 1};
}

TEST(Reference, FurnaceSumsTheGeometricSeries)
{
    const scene::Scene scene = scene::makeFurnace();
    for (const uint32_t depth : {0u, 1u, 3u})
        expectPixels(reference(scene, small(2, depth), 2000, depth), [&](uint32_t, uint32_t) {
            return 1.0 - glm::pow(dvec3(scene::FURNACE_ALBEDO), dvec3(depth + 1.0));
        });
}

TEST(Reference, PointLightFallsOffWithTheInverseSquare)
{
    scene::Scene scene = floorSeenFromAbove(scene::diffuse("floor", {0.5f, 0.4f, 0.3f}));
    scene.lights.push_back({.intensity = {1, 2, 3}, .position = {0.3f, 0.7f, -0.2f}});
    expectPixels(reference(scene, small(8, 1), 2, 1), [&](uint32_t x, uint32_t y) {
        const dvec3 to = dvec3(scene.lights[0].position) - seenPoint(x, y, 8);
        const double r = glm::length(to);
        return dvec3(scene.materials[0].baseColor) / PI * dvec3(1, 2, 3) * to.y / (r * r * r);
    });
}

TEST(Reference, SpotLightAndDirectionalLightHaveTheirForms)
{
    scene::Scene scene = floorSeenFromAbove(scene::diffuse("floor", {0.5f, 0.5f, 0.5f}));
    scene.lights.push_back({.kind = scene::LightKind::Spot,
                            .intensity = {1, 1, 1},
                            .position = {0, 1, 0},
                            .direction = {0, -1, 0},
                            .innerConeAngle = 0.2f,
                            .outerConeAngle = 0.6f});
    scene.lights.push_back(
        {.kind = scene::LightKind::Directional, .intensity = {0.1f, 0.2f, 0.3f}, .direction = {0.6f, -0.8f, 0}});
    expectPixels(reference(scene, small(8, 1), 2, 1), [&](uint32_t x, uint32_t y) {
        const dvec3 to = dvec3(0, 1, 0) - seenPoint(x, y, 8);
        const double r = glm::length(to), cosine = to.y / r;
        const double inner = std::cos(0.2f), outer = std::cos(0.6f);
        const double s = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
        return 0.5 / PI * (s * s * cosine / (r * r) + 0.8 * dvec3(0.1f, 0.2f, 0.3f));
    });
}

// The form factor of a parallel rectangle, seen from below one of its corners (Siegel and Howell, configuration 4).
TEST(Reference, RectangleLightHasItsFormFactor)
{
    scene::Scene scene = floorSeenFromAbove(scene::diffuse("floor", {0.5f, 0.5f, 0.5f}));
    const double a = 1.5, b = 0.8, height = 1.25;
    const uint32_t light = scene::addMaterial(scene, scene::emitter("light", {1, 2, 4}));
    scene::addQuad(scene, light, {0, 1.25f, 0}, {1.5f, 0, 0}, {0, 0, 0.8f}); // front down
    const auto corner = [&](double u, double v) { // of the rectangle from (0, 0) to (u, v), odd in both
        const double x = u / height, y = v / height, X = std::sqrt(1 + x * x), Y = std::sqrt(1 + y * y);
        return (x / X * std::atan(y / X) + y / Y * std::atan(x / Y)) / (2 * PI);
    };
    expectPixels(reference(scene, small(8, 1), 4000, 1), [&](uint32_t x, uint32_t y) {
        const dvec3 p = seenPoint(x, y, 8);
        const double factor =
            corner(a - p.x, b - p.z) - corner(-p.x, b - p.z) - corner(a - p.x, -p.z) + corner(-p.x, -p.z);
        return 0.5 * factor * dvec3(1, 2, 4);
    });
}

TEST(Reference, SkyLightsAFloorWithItsMeanOverTheCosine)
{
    scene::Scene scene = floorSeenFromAbove(scene::diffuse("floor", {0.5f, 0.5f, 0.5f}));
    scene.environment = {
        2, 4, {{1, 0, 0}, {0, 1, 0}, {0, 0, 3}, {0, 0, 5}, {9, 9, 9}, {9, 9, 9}, {9, 9, 9}, {9, 9, 9}}};
    // Each texel fills half the azimuth; the rows end at polar angles 45 and 90 degrees: half of the irradiance each.
    expectPixels(reference(scene, small(4, 1), 4000, 1),
                 [](uint32_t, uint32_t) { return 0.5 * dvec3(0.25, 0.25, 0.25 * 8); });
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
    ReferenceBsdf() : scene_(floorSeenFromAbove(GetParam().material)) {}
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
        Moments sampled, integrated, density, backward;
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
INSTANTIATE_TEST_SUITE_P(Of, ReferenceBsdf, testing::ValuesIn(materials()),
                         [](const auto& i) { return i.param.name; });

} // namespace
} // namespace support
