#include "passes/renderer.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "tests/support/gpu_fixture.h"
#include "tests/support/test_scenes.h"

namespace
{

using passes::Renderer;
using Pixels = std::vector<glm::vec3>;

class RendererTest : public GpuTest
{
  protected:
    void SetUp() override
    {
        GpuTest::SetUp();
        if (!IsSkipped() && device().adapter().name.find("SwiftShader") != std::string::npos)
            GTEST_SKIP() << "SKIPPED ON SwiftShader: compiling one renderer takes minutes there";
    }

    static support::TestScene sceneNamed(const std::string& name)
    {
        for (const support::TestScene& test : support::testScenes())
            if (test.name == name) return test;
        throw std::invalid_argument(name);
    }
    Renderer make(const passes::Settings& settings) { return {device(), scene_, settings}; }
    static Pixels frames(Renderer& renderer, int count)
    {
        for (int i = 0; i < count; ++i) renderer.renderFrame();
        return renderer.readMean().pixels;
    }

    const support::TestScene test_ = sceneNamed("Glossy");
    const scene::Scene scene_ = test_.make();
    const passes::Settings settings_ = test_.settings();
};

TEST_F(RendererTest, GivesEqualPixelsForEqualSettings)
{
    Renderer first = make(settings_), second = make(settings_);
    EXPECT_EQ(frames(first, 3), frames(second, 3));
}

TEST_F(RendererTest, StartsAgainAfterAReset)
{
    Renderer renderer = make(settings_);
    const Pixels before = frames(renderer, 3);
    renderer.reset();
    EXPECT_EQ(renderer.frameCount(), 0u);
    EXPECT_EQ(frames(renderer, 3), before);
}

TEST_F(RendererTest, GivesOtherPixelsForOtherSeedsAndFrames)
{
    passes::Settings other = settings_;
    other.seed = 1;
    Renderer first = make(settings_), second = make(other);
    const Pixels pixels = frames(first, 1);
    EXPECT_NE(pixels, frames(second, 1));
    first.renderFrame();
    EXPECT_NE(pixels, first.readFrame().pixels);
}

TEST_F(RendererTest, MeansAreOfAllFrames)
{
    Renderer renderer = make(settings_);
    std::vector<glm::dvec3> sum(size_t{settings_.width} * settings_.height, glm::dvec3(0));
    for (int i = 0; i < 5; ++i) {
        renderer.renderFrame();
        const Pixels frame = renderer.readFrame().pixels;
        for (size_t p = 0; p < sum.size(); ++p) sum[p] += glm::dvec3(frame[p]) / 5.0;
    }
    const Pixels mean = renderer.readMean().pixels;
    for (size_t p = 0; p < sum.size(); ++p) ASSERT_LT(glm::distance(sum[p], glm::dvec3(mean[p])), 1e-6) << p;
    EXPECT_EQ(renderer.readColor().pixels, mean);
    passes::Settings last = settings_;
    last.average = false;
    Renderer unaveraged = make(last);
    frames(unaveraged, 2);
    EXPECT_EQ(unaveraged.readColor().pixels, unaveraged.readFrame().pixels);
}

TEST_F(RendererTest, CountsItsRaysAndFindsNothingThatIsNotFinite)
{
    Renderer renderer = make(settings_);
    frames(renderer, 2);
    const passes::RenderStats stats = renderer.stats();
    EXPECT_EQ(stats.rays.at("primary"), 2u * settings_.width * settings_.height);
    EXPECT_GT(stats.rays.at("bounce"), 0u);
    EXPECT_LE(stats.rays.at("bounce"), stats.rays.at("primary") * settings_.maxBounces);
    EXPECT_GT(stats.rays.at("shadow"), 0u);
    for (const auto& [stage, count] : stats.nonFinite) EXPECT_EQ(count, 0u) << stage;
}

TEST_F(RendererTest, SeesThroughACameraThatIsSetLater)
{
    scene::Camera away = scene_.cameras[0];
    away.forward = -away.forward;
    away.right = -away.right;
    scene::Scene turned = scene_;
    turned.cameras[0] = away;
    Renderer expected(device(), turned, settings_), renderer = make(settings_);
    renderer.setCamera(away);
    EXPECT_EQ(frames(renderer, 1), frames(expected, 1));
}

// Scale is undone exactly: powers of two.
TEST_F(RendererTest, IsIndependentOfUnits)
{
    Renderer renderer = make(settings_);
    const Pixels pixels = frames(renderer, 2);
    for (const double exponent : {-40.0, 40.0}) {
        const auto factor = float(std::exp2(exponent));
        scene::Scene other = scene_;
        for (scene::Material& m : other.materials) m.emission *= factor;
        for (glm::vec3& radiance : other.environment.radiance) radiance *= factor;
        Renderer bright(device(), other, settings_);
        Pixels scaled = frames(bright, 2);
        for (glm::vec3& p : scaled) p /= factor;
        EXPECT_EQ(scaled, pixels) << "radiance times 2^" << exponent;
    }
    scene::Scene large = scene_;
    for (glm::vec3& p : large.positions) p *= 1024.0f;
    large.cameras[0].position *= 1024.0;
    Renderer far(device(), large, settings_);
    EXPECT_EQ(frames(far, 2), pixels);
}

} // namespace
