// The studies themselves.

#include "ui/window/studies.h"

#include "passes/autocovariance.h"
#include "passes/reference.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace ui
{

namespace
{

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::unique_ptr<passes::Renderer> siblingOf(const Subject& subject, const passes::Settings& settings, uint32_t runs = 1)
{
    auto renderer = std::make_unique<passes::Renderer>(subject.like, settings, runs);
    renderer->setCamera(subject.camera);
    renderer->reset(); // the camera rests
    return renderer;
}

// What a pixel sees directly.
image::Image emissionOf(const Subject& subject, passes::Settings settings)
{
    settings.method = passes::Method::Pt;
    settings.maxBounces = 0;
    const auto renderer = siblingOf(subject, settings);
    renderer->renderFrame();
    renderer->wait();
    return renderer->read(passes::LAST_FRAME);
}

// ---------------------------------------------------------------------------------------------------------- reference

constexpr double BATCH_SECONDS = 0.5; // of rendering, at least, in a batch of a reference
constexpr double GROWTH = 1.25;       // from one published state to the next

class ReferenceStudy : public Study
{
  public:
    explicit ReferenceStudy(const Subject& subject)
        : settings_(passes::referenceSettings(subject.settings)), renderer_(siblingOf(subject, settings_))
    {
        static uint64_t studies = 0; // of one thread
        number_ = ++studies;
    }

    bool step(Findings& findings) override
    {
        const auto start = Clock::now();
        renderer_->renderFrame();
        renderer_->wait();
        seconds_ += secondsSince(start);
        const bool full = batchFrames_ > 0 ? renderer_->frameCount() >= batchFrames_ : seconds_ >= BATCH_SECONDS;
        if (!full) return false;
        batchFrames_ =
            renderer_->frameCount(); // batches of equal length, so that their spread says how good the mean is
        mean_.add(renderer_->read(passes::MEAN));
        --settings_.seed;
        renderer_->apply(settings_);
        renderer_->reset();
        if (mean_.count() < 2 || double(mean_.count()) < GROWTH * double(published_)) return false;
        published_ = mean_.count();
        findings.reference = std::make_shared<const Reference>(
            Reference{.picture = mean_.mean(),
                      .name = fmt::format("path traced, {} frames", mean_.count() * batchFrames_),
                      .error = mean_.ownError(),
                      .converging = number_});
        return true;
    }

  private:
    passes::Settings settings_;
    std::unique_ptr<passes::Renderer> renderer_;
    image::MeanPicture mean_;
    uint64_t number_ = 0, batchFrames_ = 0, published_ = 0;
    double seconds_ = 0;
};

// -------------------------------------------------------------------------------------------------------- correlation

constexpr uint32_t RUNS = 16;
constexpr double CHAIN_PIXELS = 64 * 36;  // of a run, at most: statistics need many chains, not a large picture
constexpr uint32_t LONGEST_CHAIN = 1024;  // frames
constexpr uint32_t CHAIN_LAW_FRAMES = 64; // of a run and batch
constexpr uint32_t MOST_BATCHES = 32;     // then it is known well enough
constexpr uint64_t NEXT_BATCH = 0x9e3779b97f4a7c15u; // between seeds

class CorrelationStudy : public Study
{
  public:
    explicit CorrelationStudy(const Subject& subject) : side_(subject.side), settings_(small(subject.settings))
    {
        curve_.width = settings_.width;
        curve_.height = settings_.height;
        curve_.runs = RUNS;
        chainRenderer_ = siblingOf(subject, settings_, RUNS);
        if (!passes::lawHolds(settings_, subject.like.scene().viewRepeats(settings_))) return;
        emission_ = emissionOf(subject, settings_);
        lawSettings_ = passes::lawSettings(settings_);
        if (passes::accumulates(settings_.method)) lawSettings_.method = passes::Method::Pt;
        lawRenderer_ = siblingOf(subject, lawSettings_, RUNS);
    }

    bool step(Findings& findings) override
    {
        if (lawRenderer_ && (!meter_ || meter_->frames() < CHAIN_LAW_FRAMES)) {
            stepLaw();
            return false;
        }
        if (!chain_) {
            passes::Settings settings = settings_;
            settings.seed += curve_.batches * NEXT_BATCH;
            chainRenderer_->apply(settings);
            chain_.emplace(*chainRenderer_);
        }
        const size_t known = chain_->points().size();
        chain_->step();
        const bool news = chain_->points().size() > known;
        if (news) take(chain_->points().back());
        if (chain_->frame() >= std::min(settings_.maxConfidence, LONGEST_CHAIN)) {
            chain_.reset();
            meter_.reset();
            ++curve_.batches;
        }
        if (news) findings.curves[side_] = std::make_shared<const CorrelationCurve>(curve_);
        return news;
    }
    bool done() const override { return curve_.batches >= MOST_BATCHES; }

  private:
    static passes::Settings small(passes::Settings settings)
    {
        const double pixels = double(settings.width) * settings.height;
        const double scale = std::min(1.0, std::sqrt(CHAIN_PIXELS / pixels));
        settings.width = std::max(uint32_t(scale * settings.width), 1u);
        settings.height = std::max(uint32_t(scale * settings.height), 1u);
        settings.average = false;
        return settings;
    }

    void stepLaw()
    {
        if (!meter_) {
            passes::Settings settings = lawSettings_;
            settings.seed = ~(settings.seed + curve_.batches * NEXT_BATCH); // none of the chain's
            lawRenderer_->apply(settings);
            lawRenderer_->reset();
            meter_.emplace(RUNS, passes::resolvingTargets(lawSettings_.method), emission_);
        }
        lawRenderer_->renderFrame();
        lawRenderer_->wait();
        meter_->add(lawRenderer_->read(passes::LAST_FRAME));
        if (meter_->frames() == CHAIN_LAW_FRAMES) laws_.push_back(meter_->law());
    }

    void take(const passes::ChainPoint& point)
    {
        std::vector<statistics::BatchValue>& values = values_[point.frame];
        values.push_back(point.autocovariance);
        CorrelationCurve::Point shown{.frame = point.frame, .measured = statistics::combine(values)};
        if (!laws_.empty()) {
            std::vector<statistics::BatchValue> predicted, plateaus;
            for (const passes::FrameLaw& law : laws_) {
                predicted.push_back(passes::predictedAutocovariance(law, settings_.color, point.frame));
                plateaus.push_back(law.plateau);
            }
            // The first frame of weighted color would take the path tracer's law.
            if (point.frame > 2 || settings_.color == passes::Color::Chosen || passes::accumulates(settings_.method))
                shown.predicted = statistics::combine(predicted).mean;
            curve_.plateau = statistics::combine(plateaus).mean;
        }
        const auto at = std::ranges::find(curve_.points, point.frame, &CorrelationCurve::Point::frame);
        if (at == curve_.points.end())
            curve_.points.push_back(shown);
        else
            *at = shown;
    }

    Side side_;
    passes::Settings settings_, lawSettings_;
    std::unique_ptr<passes::Renderer> chainRenderer_, lawRenderer_; // the second null: the law does not hold
    image::Image emission_;
    std::optional<passes::LawMeter> meter_;
    std::optional<passes::Chain> chain_;
    std::vector<passes::FrameLaw> laws_;
    std::map<uint32_t, std::vector<statistics::BatchValue>> values_; // by M
    CorrelationCurve curve_;
};

// -------------------------------------------------------------------------------------------------------------- floor

constexpr uint32_t FIRST_FLOOR = 4, MOST_FLOOR = 4096; // frames: when it is first shown, when it is known well enough

class FloorStudy : public Study
{
  public:
    explicit FloorStudy(const Subject& subject) : side_(subject.side), settings_(passes::lawSettings(subject.settings))
    {
        if (passes::accumulates(settings_.method)) return; // there is none
        settings_.seed = ~settings_.seed;
        meter_.emplace(1, passes::resolvingTargets(settings_.method), emissionOf(subject, settings_));
        renderer_ = siblingOf(subject, settings_);
    }

    bool step(Findings& findings) override
    {
        Floor floor{.deviation = {.width = settings_.width, .height = settings_.height}};
        if (renderer_) {
            renderer_->renderFrame();
            renderer_->wait();
            meter_->add(renderer_->read(passes::LAST_FRAME));
            floor.frames = meter_->frames();
            if (floor.frames < FIRST_FLOOR || floor.frames < GROWTH * shown_) return false;
            for (const glm::dvec3& p : meter_->law().floor)
                floor.deviation.pixels.emplace_back(
                    glm::sqrt(glm::max(p, glm::dvec3(0)))); // 0 is estimated as below, too
        } else {
            floor.deviation.pixels.resize(size_t{settings_.width} * settings_.height);
        }
        shown_ = floor.frames;
        done_ = !renderer_ || shown_ >= MOST_FLOOR;
        findings.floors[side_] = std::make_shared<const Floor>(std::move(floor));
        return true;
    }
    bool done() const override { return done_; }

  private:
    Side side_;
    passes::Settings settings_;
    std::optional<passes::LawMeter> meter_;
    std::unique_ptr<passes::Renderer> renderer_; // null: every channel has a reservoir of its own
    uint32_t shown_ = 0;
    bool done_ = false;
};

// ------------------------------------------------------------------------------------------------------------ savings

constexpr uint32_t WARM_FRAMES = 2, LEAST_FRAMES = 8, MOST_FRAMES = 64; // of each renderer
constexpr double ENOUGH_SECONDS = 4;                                    // of frames that count

class SavingsStudy : public Study
{
  public:
    explicit SavingsStudy(const Subject& subject)
        : needed_(siblingOf(subject, subject.settings)),
          everything_(std::make_unique<passes::Renderer>(subject.like.device(), subject.scene, subject.settings,
                                                         std::function<void(double)>(), scene::FeatureSet::Everything))
    {
        everything_->setCamera(subject.camera);
        everything_->reset();
        savings_.neededBytes = needed_->stats().sceneBytes;
        savings_.everythingBytes = everything_->stats().sceneBytes;
    }

    // In turns, so that what disturbs the machine disturbs both.
    bool step(Findings& findings) override
    {
        const double needed = secondsOf(*needed_), everything = secondsOf(*everything_);
        if (++frames_ <= WARM_FRAMES) return false;
        seconds_[0] += needed;
        seconds_[1] += everything;
        savings_.frames = frames_ - WARM_FRAMES;
        savings_.neededMilliseconds = 1000 * seconds_[0] / savings_.frames;
        savings_.everythingMilliseconds = 1000 * seconds_[1] / savings_.frames;
        findings.savings = savings_;
        if (done()) needed_.reset(), everything_.reset();
        return true;
    }
    bool done() const override
    {
        return savings_.frames >= MOST_FRAMES ||
               (savings_.frames >= LEAST_FRAMES && seconds_[0] + seconds_[1] > ENOUGH_SECONDS);
    }

  private:
    static double secondsOf(passes::Renderer& renderer)
    {
        const auto start = Clock::now();
        renderer.renderFrame();
        renderer.wait();
        return secondsSince(start);
    }

    std::unique_ptr<passes::Renderer> needed_, everything_;
    uint32_t frames_ = 0;
    double seconds_[2] = {0, 0};
    Savings savings_;
};

} // namespace

std::unique_ptr<Study> makeReferenceStudy(const Subject& subject)
{
    return std::make_unique<ReferenceStudy>(subject);
}

std::unique_ptr<Study> makeCorrelationStudy(const Subject& subject)
{
    if (subject.settings.method == passes::Method::Pt || subject.settings.maxConfidence < 2) return nullptr;
    return std::make_unique<CorrelationStudy>(subject);
}

std::unique_ptr<Study> makeFloorStudy(const Subject& subject)
{
    return std::make_unique<FloorStudy>(subject);
}

std::unique_ptr<Study> makeSavingsStudy(const Subject& subject)
{
    return std::make_unique<SavingsStudy>(subject);
}

} // namespace ui
