// Scattering on the device: its values against the float64 reference, its samples against their own density and values.

#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>

#include "engine/base/statistics.h"
#include "engine/scene/shapes.h"
#include "tests/support/chi_squared.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/reference_material.h"
#include "tests/support/scene_buffers.h"

namespace
{

using glm::dvec3;
using support::ReferenceSurface;

constexpr double PI = std::numbers::pi;

struct NamedMaterial {
    const char* name;
    scene::Material material;
};

std::vector<NamedMaterial> materials()
{
    const glm::vec4 color = {0.8f, 0.5f, 0.3f, 1};
    const auto make = [&](float metallic, float roughness, float transmission, bool thin) {
        scene::Material m = {.baseColor = color, .metallic = metallic, .roughness = roughness};
        m.transmission = transmission;
        m.thin = thin;
        return m;
    };
    scene::Material lambert = make(0, 1, 0, true), tinted = make(0.4f, 0.5f, 0, true);
    lambert.specular = 0;
    tinted.specular = 0.6f;
    tinted.specularColor = {1, 0.2f, 0.5f};
    tinted.ior = 2.2f;
    scene::Material weak = make(0.1f, 0.5f, 0.6f, false);
    weak.ior = 1.2f;
    weak.specularColor = {0.5f, 1, 1};
    return {{"Lambert", lambert},
            {"Glossy", make(0, 0.4f, 0, true)},
            {"Polished", make(0, 0, 0, true)},
            {"Tinted", tinted},
            {"RoughMetal", make(1, 1, 0, true)},
            {"SmoothMetal", make(1, 0.3f, 0, true)},
            {"Mirror", make(1, 0.01f, 0, true)},
            {"ClearPane", make(0, 0, 0.8f, true)},
            {"FrostedPane", make(0, 0.5f, 0.8f, true)},
            {"ClearGlass", make(0, 0, 1, false)},
            {"FrostedGlass", make(0, 0.5f, 1, false)},
            {"WeakGlass", weak}};
}

struct Evaluated {
    glm::vec3 value; // f |cos|
    float density = 0;
    glm::vec4 unused;
};
struct Sampled {
    glm::vec3 weight;
    float density = 0;
    glm::vec3 direction;
    float dirac = 0;
};

dvec3 direction(double cosine, double phi)
{
    const double sine = std::sqrt(1 - cosine * cosine);
    return {sine * std::cos(phi), cosine, sine * std::sin(phi)};
}

// One material on the plane y = 0, whose shading normal leans.
class Bsdf : public GpuTest
{
  protected:
    void use(const scene::Material& material)
    {
        scene_ = {};
        scene::addQuad(scene_, scene::addMaterial(scene_, material), {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
        // One of those that packing into 16 bits a coordinate keeps exactly.
        for (glm::vec3& n : scene_.normals) n = glm::vec3(glm::normalize(dvec3(5041, 25206, 32767 - 5041 - 25206)));
    }

    template <class Result>
    std::vector<Result> compute(const dvec3& wo, const std::vector<glm::vec4>& directions, uint32_t count, bool sample)
    {
        const support::SceneBuffers scene(device(), scene_);
        const gpu::Buffer in = upload("view", std::vector<glm::vec4>{glm::vec4(glm::vec3(wo), 0)}),
                          at = upload("directions", directions), out = create<Result>("results", count);
        run({.shader = TEST_SPIRV_DIR "/bsdf_test",
             .constants = {{"SAMPLE", sample}},
             .buffers = scene.with({{"View", &in}, {"Directions", &at}, {"Results", &out}}),
             .threads = {count}});
        return download<Result>(out);
    }
    std::vector<Evaluated> evaluate(const dvec3& wo, const std::vector<dvec3>& directions)
    {
        std::vector<glm::vec4> list;
        for (const dvec3& wi : directions) list.emplace_back(glm::vec3(wi), 0);
        return compute<Evaluated>(wo, list, uint32_t(list.size()), false);
    }
    std::vector<Sampled> sample(const dvec3& wo, uint32_t count)
    {
        return compute<Sampled>(wo, {glm::vec4(0)}, count, true);
    }
    ReferenceSurface reference(const dvec3& wo) const { return {scene_, {0, 0.25, 0.25}, wo}; }

    void forEachSurface(const std::function<void(const dvec3& wo)>& check)
    {
        for (const NamedMaterial& m : materials()) {
            use(m.material);
            std::vector<dvec3> views = {direction(0.1, 4), direction(-0.5, 2), direction(1, 0), direction(0.7, 1)};
            if (isSlow(device()) && !std::getenv("TRICHROME_TEST_DRIVERS")) views.resize(2); // minutes otherwise
            for (const dvec3& view : views) {
                SCOPED_TRACE(testing::Message() << m.name << " seen at cosine " << view.y);
                check(dvec3(glm::normalize(glm::vec3(view)))); // as float32 has it
            }
        }
    }

    scene::Scene scene_;
};

TEST_F(Bsdf, HasTheValuesOfTheModel)
{
    support::Random random(1);
    forEachSurface([&](const dvec3& wo) {
        std::vector<dvec3> directions;
        for (int i = 0; i < 4000; ++i)
            directions.push_back(dvec3(glm::normalize(
                glm::vec3(direction(2 * support::uniform(random) - 1, 2 * PI * support::uniform(random))))));
        const ReferenceSurface surface = reference(wo);
        for (int i = 0; i < 1000; ++i) directions.push_back(surface.sample(random).wi); // where the lobes are
        const std::vector<Evaluated> results = evaluate(wo, directions);
        for (size_t i = 0; i < directions.size(); ++i) {
            const dvec3 expected = surface.evaluate(directions[i]) * surface.cosine(directions[i]);
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(results[i].value[c], expected[c], 5e-4 * expected[c] + 1e-6)
                    << "direction " << i << ", channel " << c;
        }
    });
}

TEST_F(Bsdf, SamplesWithTheDensityItClaims)
{
    constexpr int ROWS = 24, COLUMNS = 24, STEPS = 24; // bins of x and the azimuth about it: no lobe is at a pole
    constexpr uint32_t SAMPLES = 1 << 18;
    std::vector<dvec3> grid; // midpoints of a fine grid, bin by bin
    for (int bin = 0; bin < ROWS * COLUMNS; ++bin)
        for (int step = 0; step < STEPS * STEPS; ++step) {
            const std::div_t place = std::div(bin, COLUMNS), within = std::div(step, STEPS);
            const double row = place.quot + (within.quot + 0.5) / STEPS;
            const double column = place.rem + (within.rem + 0.5) / STEPS;
            const double x = 1 - 2 * row / ROWS, phi = 2 * PI * column / COLUMNS;
            grid.emplace_back(x, std::sqrt(1 - x * x) * std::cos(phi), std::sqrt(1 - x * x) * std::sin(phi));
        }
    forEachSurface([&](const dvec3& wo) {
        const std::vector<Sampled> samples = sample(wo, SAMPLES);
        const std::vector<Evaluated> densities = evaluate(wo, grid);
        std::vector<double> counts(size_t{ROWS} * COLUMNS, 0), expected(counts);
        for (size_t i = 0; i < grid.size(); ++i)
            expected[i / (size_t{STEPS} * STEPS)] +=
                double{SAMPLES} * densities[i].density * 4 * PI / double(ROWS * COLUMNS * STEPS * STEPS);
        double lost = 0;
        for (const Sampled& s : samples) {
            if (s.dirac > 0 || s.direction == glm::vec3(0)) {
                ++lost;
                continue;
            }
            const double phi = std::atan2(double{s.direction.z}, double{s.direction.y}) / (2 * PI);
            const int row = std::min(int((1 - s.direction.x) / 2 * ROWS), ROWS - 1);
            const int column = std::min(int((phi < 0 ? phi + 1 : phi) * COLUMNS), COLUMNS - 1);
            ++counts[size_t(row * COLUMNS + column)];
        }
        double sum = 0;
        for (const double e : expected) sum += e;
        EXPECT_NEAR(sum + lost, SAMPLES, 0.004 * SAMPLES); // the density of all that is not lost
        counts.push_back(lost);
        expected.push_back(SAMPLES - sum);
        if (sum == 0) return; // all Dirac
        EXPECT_GT(statistics::chiSquaredTest(counts, expected, 20).p, 1e-5);
    });
}

// A sample's weight is the value over the density, both asked for again; Dirac ones, the reference's.
TEST_F(Bsdf, WeighsSamplesByValueOverDensity)
{
    forEachSurface([&](const dvec3& wo) {
        const std::vector<Sampled> samples = sample(wo, 4096);
        std::vector<dvec3> directions;
        for (const Sampled& s : samples) directions.push_back(s.direction == glm::vec3(0) ? wo : dvec3(s.direction));
        const std::vector<Evaluated> values = evaluate(wo, directions);
        for (size_t i = 0; i < samples.size(); ++i) {
            if (samples[i].dirac > 0 || samples[i].direction == glm::vec3(0)) continue;
            ASSERT_NEAR(samples[i].density, values[i].density, 1e-3 * values[i].density) << i;
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(samples[i].weight[c] * samples[i].density, values[i].value[c],
                            1e-3 * values[i].value[c] + 1e-6)
                    << i;
        }
    });
}

// All that leaves, Dirac or not, is what the reference says.
TEST_F(Bsdf, HasTheAlbedoOfTheModel)
{
    support::Random random(2);
    forEachSurface([&](const dvec3& wo) {
        statistics::Moments device, expected;
        for (const Sampled& s : sample(wo, 1 << 17)) device.add(s.weight.x);
        const ReferenceSurface surface = reference(wo);
        for (int i = 0; i < 200000; ++i) expected.add(surface.sample(random).weight.x);
        const statistics::Difference d = statistics::compare(estimateOf(device), estimateOf(expected), 1e-5);
        EXPECT_GT(d.p, 1e-5) << device.mean() << " against " << expected.mean();
        EXPECT_LE(device.mean(), 1 + 5 * std::sqrt(device.varianceOfMean()) + 1e-6);
    });
}

} // namespace
