#include <cmath>
#include <functional>
#include <numbers>

#include <glm/glm.hpp>

#include "engine/base/statistics.h"
#include "tests/support/chi_squared.h"
#include "tests/support/gpu_fixture.h"

namespace
{

constexpr double PI = std::numbers::pi;
constexpr uint32_t SAMPLES = 1 << 20;
constexpr int BINS = 32; // along each of two coordinates

enum Routine : uint32_t { Cosine, Triangle, VisibleNormal, Circle, Pick };

class Sampling : public GpuTest
{
  protected:
    std::vector<glm::vec4> sample(Routine routine, glm::vec4 parameters = glm::vec4(0))
    {
        const gpu::Buffer in = upload("parameters", std::vector<glm::vec4>{parameters}),
                          out = create<glm::vec4>("samples", SAMPLES);
        run({.shader = TEST_SPIRV_DIR "/sampling_test",
             .constants = {{"ROUTINE", routine}},
             .buffers = {{"Parameters", &in}, {"Samples", &out}},
             .threads = {SAMPLES}});
        return download<glm::vec4>(out);
    }

    // `coordinates` maps samples to [0, 1)^2, over which they have the density.
    static double pOf(const std::vector<glm::vec4>& samples,
                      const std::function<glm::dvec2(const glm::dvec3&)>& coordinates,
                      const std::function<double(double, double)>& density)
    {
        std::vector<double> counts(size_t{BINS} * BINS, 0), expected(counts);
        for (const glm::vec4& s : samples) {
            const glm::dvec2 at = coordinates(glm::dvec3(s)) * double{BINS};
            const int i = std::min(int(at.x), BINS - 1), j = std::min(int(at.y), BINS - 1);
            ++counts[size_t(i * BINS + j)];
        }
        constexpr int STEPS = 16; // of the midpoint rule, in each bin and direction
        double sum = 0;
        for (int i = 0; i < BINS * STEPS; ++i)
            for (int j = 0; j < BINS * STEPS; ++j) {
                const double value = density((i + 0.5) / (BINS * STEPS), (j + 0.5) / (BINS * STEPS));
                expected[size_t(i / STEPS * BINS + j / STEPS)] += value;
                sum += value;
            }
        EXPECT_NEAR(sum / std::pow(BINS * STEPS, 2), 1, 2e-3); // a density
        for (double& e : expected) e *= double(samples.size()) / sum;
        return statistics::chiSquaredTest(counts, expected).p;
    }
    static double uniform(double, double) { return 1; }
    static double turns(const glm::dvec3& w) // azimuth in [0, 1)
    {
        const double phi = std::atan2(w.y, w.x) / (2 * PI);
        return phi < 0 ? phi + 1 : phi;
    }
};

TEST_F(Sampling, HemisphereFollowsTheCosine)
{
    const std::vector<glm::vec4> samples = sample(Cosine);
    for (const glm::vec4& s : samples) ASSERT_NEAR(glm::length(glm::dvec3(s)), 1, 1e-6);
    EXPECT_GT(pOf(
                  samples, [](const glm::dvec3& w) { return glm::dvec2(w.z * w.z, turns(w)); }, uniform),
              1e-4);
}

// Far more exact than a device's own functions need be.
TEST_F(Sampling, CirclesAndAnglesAreExact)
{
    for (const glm::vec4& s : sample(Circle)) {
        const double angle = 2 * PI * double{s.z}, again = 2 * PI * double{s.w};
        ASSERT_NEAR(double{s.x}, std::cos(angle), 2e-7) << s.z;
        ASSERT_NEAR(double{s.y}, std::sin(angle), 2e-7) << s.z;
        ASSERT_NEAR(std::remainder(again - angle, 2 * PI), 0, 7e-7) << s.z; // of both
    }
}

// 2^32 numbers shared out among 3 * 2^30 indices: with no more than 32 bits every third index had half of them.
TEST_F(Sampling, PicksAmongManyAreEven)
{
    std::vector<double> counts(size_t{3} * BINS, 0);
    for (const glm::vec4& s : sample(Pick))
        ++counts[size_t(int(s.x) * BINS + std::min(int(s.y * float(BINS)), BINS - 1))];
    const std::vector<double> expected(counts.size(), double{SAMPLES} / double(counts.size()));
    EXPECT_GT(statistics::chiSquaredTest(counts, expected).p, 1e-4);
}

TEST_F(Sampling, TriangleIsCoveredUniformly)
{
    const std::vector<glm::vec4> samples = sample(Triangle);
    for (const glm::vec4& s : samples) ASSERT_TRUE(s.x >= 0 && s.y >= 0 && s.x + s.y <= 1);
    const auto coordinates = [](const glm::dvec3& p) { return glm::dvec2((1 - p.x) * (1 - p.x), p.y / (1 - p.x)); };
    EXPECT_GT(pOf(samples, coordinates, uniform), 1e-4);
}

// The density of visible normals, D max(o.h, 0) G1 / cos o, over the azimuth and w, where 1 - w^2 is the
// cumulative sum of D cos h: smooth up to grazing.
TEST_F(Sampling, NormalsAreAsVisible)
{
    for (const double width : {1.0, 0.3, 0.05})
        for (const double cosine : {1.0, 0.5, 0.1}) {
            const glm::dvec3 wo(std::sqrt(1 - cosine * cosine), 0, cosine);
            const std::vector<glm::vec4> samples = sample(VisibleNormal, glm::vec4(glm::vec3(wo), float(width)));
            const double a2 = width * width, tan2 = (1 - cosine * cosine) / (cosine * cosine);
            const double g1 = 2 / (1 + std::sqrt(1 + a2 * tan2));
            const auto coordinates = [&](const glm::dvec3& h) {
                const double sine2 = h.x * h.x + h.y * h.y; // not 1 - z^2, which cancels
                return glm::dvec2(std::sqrt(a2 * h.z * h.z / (sine2 + a2 * h.z * h.z)), turns(h));
            };
            const auto density = [&](double w, double turn) {
                const double scale = std::sqrt(1 + (a2 - 1) * (1 - w * w)), cosH = w / scale; // cosH / w is smooth
                const double oh = wo.x * std::sqrt(1 - cosH * cosH) * std::cos(2 * PI * turn) + wo.z * cosH;
                return 2 * scale * std::max(oh, 0.0) * g1 / cosine;
            };
            EXPECT_GT(pOf(samples, coordinates, density), 1e-4) << "alpha_g " << width << ", cosine " << cosine;
        }
}

} // namespace
