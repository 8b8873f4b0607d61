// Batches, a frame a step: on a scene of a few pixels.

#include "passes/experiments/correlator.h"

#include "tests/support/gpu_fixture.h"
#include "tests/support/test_scenes.h"

namespace
{

using passes::CorrelationBatch;
using passes::Correlator;
using passes::Method;
using passes::Renderer;
using passes::Settings;

constexpr uint32_t RUNS = 3;
enum : size_t { PLAIN, ONE, EACH };

class CorrelatorTest : public RendererFixture
{
  protected:
    CorrelatorTest()
    {
        base_.width = 8;
        base_.height = 6;
        base_.maxBounces = 2;
        base_.spatial = 0;
        base_.frames = 8;
        base_.color = passes::Color::Chosen;
        base_.average = false;
    }

    Settings with(Method method) const
    {
        Settings settings = base_;
        settings.method = method;
        return settings;
    }

    Correlator correlator(passes::CameraAt cameraAt = {})
    {
        return {std::make_unique<Renderer>(device(), scene_, passes::emissionSettings(base_)),
                base_,
                {{"one", with(Method::RestirPt)}, {"each", with(Method::RgbRestir)}},
                std::move(cameraAt)};
    }

    static CorrelationBatch batch(Correlator& correlator, size_t subject, uint32_t index)
    {
        correlator.begin(subject, index, RUNS);
        while (!correlator.complete()) correlator.step();
        return correlator.batch();
    }

    const scene::Scene scene_ = support::testScenes().front().make();
    Settings base_;
};

} // namespace

TEST_F(CorrelatorTest, MeasuresTheLawThatAMethodLacksAndItsChain)
{
    Correlator correlator = this->correlator();
    const auto& subjects = correlator.subjects();
    ASSERT_EQ(subjects.size(), 3u);
    EXPECT_EQ(subjects[PLAIN].name, passes::PATH_TRACER);
    EXPECT_EQ(subjects[PLAIN].chainFrames, 0u);
    EXPECT_EQ(subjects[ONE].chainFrames, base_.frames);
    EXPECT_EQ(subjects[EACH].lawFrames, 0u); // it is the path tracer's
    EXPECT_EQ(subjects[PLAIN].lawFrames, subjects[ONE].lawFrames);

    const CorrelationBatch plain = batch(correlator, PLAIN, 0), one = batch(correlator, ONE, 0),
                           each = batch(correlator, EACH, 0);
    EXPECT_TRUE(plain.law && plain.points.empty());
    EXPECT_TRUE(one.law && one.points.size() == 3); // M = 2, 4, 8
    EXPECT_TRUE(!each.law && each.points.size() == 3);

    // The chain is what the method's renderer gives alone.
    Renderer alone(device(), scene_, with(Method::RestirPt), {}, RUNS);
    passes::Chain chain(alone);
    while (chain.frame() < base_.frames) chain.step();
    EXPECT_EQ(chain.points(), one.points);
}

// A measurement that is resumed, or shared by processes, measures each batch in whatever company.
TEST_F(CorrelatorTest, ABatchIsTheSameWhateverWasMeasuredBefore)
{
    Correlator first = correlator(), second = correlator();
    const CorrelationBatch zero = batch(first, ONE, 0), one = batch(first, ONE, 1);
    EXPECT_EQ(batch(second, ONE, 1), one);
    EXPECT_FALSE(zero.law == one.law || zero.points == one.points);
    second.begin(ONE, 0, RUNS);
    second.step();
    EXPECT_EQ(batch(second, ONE, 0), zero); // and one that was begun and left
}

TEST_F(CorrelatorTest, ABatchThatStopsKeepsWhatItHas)
{
    Correlator correlator = this->correlator();
    correlator.begin(ONE, 0, RUNS);
    EXPECT_FALSE(correlator.step());
    EXPECT_FALSE(correlator.batch().law);
    int news = 0;
    for (uint32_t frame = 1; frame < correlator.subjects()[ONE].lawFrames + 4; ++frame) news += correlator.step();
    EXPECT_EQ(news, 3); // the law, M = 2, M = 4
    EXPECT_FALSE(correlator.complete());
    EXPECT_TRUE(correlator.batch().law);
    EXPECT_EQ(correlator.batch().points.size(), 2u);
}

TEST_F(CorrelatorTest, NoLawIsKnownOfAMovingCamera)
{
    Correlator moving = correlator(passes::cameraOrbit(scene_.cameras[0], 20));
    EXPECT_FALSE(moving.sameView());
    EXPECT_EQ(moving.subjects()[ONE].lawFrames, 0u);
    EXPECT_GT(moving.subjects()[PLAIN].lawFrames, 0u); // its variance is a figure of its own
    EXPECT_EQ(batch(moving, ONE, 0).points.size(), 3u);
}
