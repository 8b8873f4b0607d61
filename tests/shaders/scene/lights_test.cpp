// Next-event estimation: samples of lights come with the density that finding them by a ray is weighed with.

#include <cmath>
#include <map>
#include <numbers>

#include "engine/base/statistics.h"
#include "engine/scene/shapes.h"
#include "tests/support/chi_squared.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/scene_buffers.h"

namespace
{

constexpr double PI = std::numbers::pi;
constexpr uint32_t SAMPLES = 1 << 18;

struct LightSample {
    glm::vec3 radiance;
    float density = 0;
    glm::vec3 direction;
    float kind = 0; // 0 surface, 1 Dirac, 2 environment
    float densityAgain = 0, redAgain = 0, triangle = 0, unused = 0;
};

class Lights : public GpuTest
{
  protected:
    // Four parallelograms around the origin, none behind another.
    static scene::Scene lamps()
    {
        scene::Scene scene;
        const auto add = [&](glm::vec3 radiance, glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
            scene::addQuad(scene, scene::addMaterial(scene, scene::emitter("lamp", radiance)), corner, u, v);
        };
        add({1, 2, 3}, {-1, -1, -2}, {2, 0, 0}, {0, 1, 0});
        add({5, 0, 0}, {3, -1, 0}, {0, 0.1f, 0}, {0, 0, 0.3f}); // its back is towards the origin
        add({0, 0.1f, 0}, {0, 2, 1}, {1, 0, 0}, {0, 0.5f, 0.5f});
        add({8, 9, 2}, {-3, 0, 0}, {0, 0.2f, 0}, {0, 0, 0.2f});
        return scene;
    }

    std::vector<LightSample> sample(const scene::Scene& scene, std::vector<glm::vec4> from = {glm::vec4(0)},
                                    uint32_t count = SAMPLES)
    {
        const support::SceneBuffers buffers(device(), scene);
        scale_ = buffers.tables().radianceScale;
        for (glm::vec4& origin : from) origin *= float(buffers.tables().lengthScale);
        const gpu::Buffer origins = upload("origins", from), results = create<LightSample>("results", count);
        run({.shader = TEST_SPIRV_DIR "/lights_test",
             .buffers = buffers.with({{"Origins", &origins}, {"Results", &results}}),
             .threads = {count}});
        return download<LightSample>(results);
    }

    double scale_ = 1; // of radiance
};

TEST_F(Lights, ComeWithTheDensityOfTheirDirection)
{
    scene::Scene scene = lamps();
    scene.environment = {16, 1024, {}}; // neighbors differ
    for (int i = 0; i < 16 * 1024; ++i)
        scene.environment.radiance.push_back(0.1f * glm::vec3(float(1 + i * 7 % 1009 % 11)));
    std::map<float, size_t> kinds;
    for (const LightSample& s : sample(scene)) {
        ++kinds[s.kind];
        ASSERT_NEAR(glm::length(glm::dvec3(s.direction)), 1, 1e-6);
        ASSERT_NEAR(s.densityAgain, s.density, 1e-5 * double{s.density});
        ASSERT_EQ(s.redAgain, s.radiance.r);
    }
    EXPECT_GT(kinds[0], SAMPLES / 100);
    EXPECT_GT(kinds[2], SAMPLES / 100);
    EXPECT_EQ(kinds[1], 0u);
}

// The mean of 1 / density is the solid angle that the sampled lights fill; of radiance / density, the fluence.
TEST_F(Lights, AreSampledWithTheDensityTheyClaim)
{
    scene::Scene scene = lamps();
    std::map<uint32_t, statistics::Moments> solidAngle; // by parallelogram
    for (const LightSample& s : sample(scene))
        for (uint32_t quad = 0; quad < 4; ++quad) {
            const bool here = uint32_t(s.triangle) / 2 == quad && s.densityAgain > 0;
            solidAngle[quad].add(here ? 1 / double{s.density} : 0);
        }
    for (uint32_t quad = 0; quad < 4; ++quad) {
        double expected = 0; // Van Oosterom and Strackee 1983, of both triangles
        for (uint32_t t = 2 * quad; t < 2 * quad + 2; ++t) {
            glm::dvec3 v[3];
            for (size_t i = 0; i < 3; ++i)
                v[i] = glm::normalize(glm::dvec3(scene.positions[scene.triangles[t].vertices[i]]));
            const double volume = std::abs(glm::dot(v[0], glm::cross(v[1], v[2])));
            expected += 2 * std::atan2(volume, 1 + glm::dot(v[0], v[1]) + glm::dot(v[1], v[2]) + glm::dot(v[2], v[0]));
        }
        const statistics::Moments& found = solidAngle[quad];
        EXPECT_NEAR(found.mean(), expected, 4.5 * std::sqrt(found.varianceOfMean()) + 1e-4 * expected) << quad;
        EXPECT_LT(std::sqrt(found.varianceOfMean()), 0.1 * expected) << quad; // else it shows nothing
    }
}

TEST_F(Lights, OfTheSkyAreSampledWithTheDensityTheyClaim)
{
    scene::Scene scene;
    scene::addQuad(scene, scene::addMaterial(scene, scene::diffuse("far", {1, 1, 1})), {0, -50, 0}, {1, 0, 0},
                   {0, 0, 1});
    scene.environment = {8, 4, {}};
    for (int i = 0; i < 32; ++i) scene.environment.radiance.push_back(glm::vec3(float(1 + i * 7 % 11)));
    std::vector<double> counts(32, 0), expected(32, 0);
    double sum = 0;
    const auto weight = [&](uint32_t i) { // of a texel: radiance times solid angle
        const uint32_t row = i / 8;
        const double band = std::cos(PI * row / 4) - std::cos(PI * (row + 1) / 4);
        return double{scene.environment.radiance[i].x} * band * 2 * PI / 8;
    };
    for (uint32_t i = 0; i < 32; ++i) sum += weight(i);
    for (uint32_t i = 0; i < 32; ++i) expected[i] = SAMPLES * weight(i) / sum;
    for (const LightSample& s : sample(scene)) {
        ASSERT_EQ(s.kind, 2);
        const double azimuth = std::atan2(double{s.direction.z}, double{s.direction.x}) / (2 * PI);
        const auto column = std::min(int((azimuth < 0 ? azimuth + 1 : azimuth) * 8), 7);
        const auto row = std::min(int(std::acos(std::min(std::max(double{s.direction.y}, -1.0), 1.0)) / PI * 4), 3);
        const auto texel = uint32_t(row * 8 + column);
        ++counts[texel];
        const double radiance = double{scene.environment.radiance[texel].x};
        ASSERT_NEAR(double{s.radiance.x} / scale_, radiance, 1e-6 * radiance);
        ASSERT_NEAR(double{s.density}, radiance / sum, 1e-6 * radiance / sum);
    }
    EXPECT_GT(statistics::chiSquaredTest(counts, expected).p, 1e-4);
}

// glTF's falloff in float64, across cones from wide to as narrow as float32 can aim: the lit disc's radius, and the
// intensity up to the rounding of a direction, 2e-7 radians. From anywhere else there is nothing.
TEST_F(Lights, OfNarrowConesHaveTheirFalloff)
{
    for (const double angle : {10.0, 1.0, 0.1, 0.01, 0.001})
        for (const double innerPart : {0.0, 0.5, 0.99})
            for (const glm::vec3 along : {glm::vec3(0, -1, 0), glm::normalize(glm::vec3(0.3f, -0.8f, 0.5f))}) {
                const auto outer = float(angle * PI / 180), inner = float(innerPart) * outer;
                scene::Scene scene;
                scene::addQuad(scene, scene::addMaterial(scene, scene::diffuse("far", {1, 1, 1})), {0, -3, 0},
                               {1, 0, 0}, {0, 0, 1});
                scene.lights.push_back({.kind = scene::LightKind::Spot,
                                        .direction = along,
                                        .innerConeAngle = inner,
                                        .outerConeAngle = outer});
                std::vector<glm::vec4> from; // across the cone and as far again beyond it
                const glm::dvec3 axis = along, aside = glm::normalize(glm::cross(axis, glm::dvec3(0.6, 0, 0.8)));
                for (int i = 0; i <= 512; ++i)
                    from.emplace_back(glm::vec3(axis + aside * std::tan(double{outer} * i / 256)), 0);
                const std::vector<LightSample> samples = sample(scene, from, uint32_t(from.size()));
                for (size_t i = 0; i < from.size(); ++i) {
                    const glm::dvec3 at = glm::dvec3(from[i]);
                    const double theta = std::atan2(glm::length(glm::cross(at, axis)), glm::dot(at, axis));
                    const auto law = [&](double t) { // cos a - cos b as a product
                        const double o = double{outer}, n = double{inner};
                        const double x = std::sin((o + t) / 2) * std::sin((o - t) / 2) /
                                         (std::sin((o + n) / 2) * std::sin((o - n) / 2));
                        return std::pow(std::clamp(x, 0.0, 1.0), 2) / glm::dot(at, at) * scale_;
                    };
                    SCOPED_TRACE(testing::Message() << angle << " degrees, inner part " << innerPart << ", at "
                                                    << theta / double{outer} << " of the outer cone");
                    ASSERT_LE(double{samples[i].radiance.r}, law(std::max(theta - 2e-7, 0.0)) * (1 + 1e-6));
                    ASSERT_GE(double{samples[i].radiance.r}, law(theta + 2e-7) * (1 - 1e-6));
                }
            }
}

// Every kind is picked; where it is Dirac, the radiance is irradiance by its law.
TEST_F(Lights, WithoutExtentHaveTheirLaws)
{
    scene::Scene scene;
    scene::addQuad(scene, scene::addMaterial(scene, scene::diffuse("far", {1, 1, 1})), {0, -9, 0}, {1, 0, 0},
                   {0, 0, 1});
    scene.lights.push_back({.intensity = {3, 2, 1}, .position = {0, 0, -2}});
    scene.lights.push_back({.kind = scene::LightKind::Spot,
                            .intensity = {10, 10, 10},
                            .position = {3, 0, 0},
                            .direction = glm::normalize(glm::vec3(-3, 1, 0)),
                            .innerConeAngle = 0.1f,
                            .outerConeAngle = 0.7f});
    scene.lights.push_back({.kind = scene::LightKind::Directional, .intensity = {0.5f, 1, 2}, .direction = {0, -1, 0}});
    std::map<int, statistics::Moments> red; // by the axis towards the light
    for (const LightSample& s : sample(scene)) {
        ASSERT_EQ(s.kind, 1);
        const int axis = s.direction.x > 0.9f ? 0 : s.direction.y > 0.9f ? 1 : 2;
        for (int a = 0; a < 3; ++a) red[a].add(a == axis ? s.radiance.r / s.density / scale_ : 0);
    }
    const double cosine = 3 / std::sqrt(10.0), inner = std::cos(double{0.1f}), outer = std::cos(double{0.7f});
    const double x = (cosine - outer) / (inner - outer);
    const double expected[] = {10 * x * x / 9, 0.5, 3.0 / 4};
    for (int a = 0; a < 3; ++a)
        EXPECT_NEAR(red[a].mean(), expected[a], 4.5 * std::sqrt(red[a].varianceOfMean()) + 1e-5) << "axis " << a;
}

} // namespace
