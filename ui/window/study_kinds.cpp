// The studies themselves, and the list of them.

#include "ui/window/studies.h"

#include "engine/base/clock.h"
#include "passes/experiments/correlator.h"
#include "passes/experiments/reference.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace ui
{

namespace
{

std::unique_ptr<passes::Renderer> siblingOf(const Subject& subject, const passes::Settings& settings, uint32_t runs = 1)
{
    auto renderer = std::make_unique<passes::Renderer>(subject.like, settings, runs);
    renderer->setCamera(subject.camera);
    renderer->reset(); // the camera rests
    return renderer;
}

// ---------------------------------------------------------------------------------------------------------- reference

constexpr double BATCH_SECONDS = 0.5; // of rendering, at least, in a batch of a reference
constexpr double GROWTH = 1.25;       // from one published state to the next

class ReferenceStudy : public Study
{
  public:
    explicit ReferenceStudy(const Subject& subject)
        : tracer_(siblingOf(subject, passes::referenceSettings(subject.settings)))
    {
        static uint64_t studies = 0; // of one thread
        number_ = ++studies;
    }

    bool step(Findings& findings) override
    {
        const auto start = Clock::now();
        if (length_ == 0 && seconds_ >= BATCH_SECONDS) length_ = tracer_.renderer().frameCount() + 1;
        const bool full = tracer_.step(length_);
        tracer_.renderer().wait();
        seconds_ += secondsSince(start);
        const image::MeanPicture& mean = tracer_.mean();
        if (!full || mean.count() < 2 || double(mean.count()) < GROWTH * double(published_)) return false;
        published_ = mean.count();
        findings.reference = std::make_shared<const Reference>(
            Reference{.picture = mean.mean(),
                      .name = fmt::format("path traced, {} frames", mean.count() * length_),
                      .error = mean.ownError(),
                      .converging = number_});
        return true;
    }

  private:
    passes::ReferenceTracer tracer_;
    uint64_t number_ = 0, published_ = 0;
    uint64_t length_ = 0; // of a batch, in frames; 0: the first is not long enough yet
    double seconds_ = 0;
};

// -------------------------------------------------------------------------------------------------------- correlation

constexpr uint32_t RUNS = 16;
constexpr double CHAIN_PIXELS = 64 * 36; // of a run, at most: statistics need many chains, not a large picture
constexpr uint32_t LONGEST_CHAIN = 1024; // frames
constexpr uint32_t MOST_BATCHES = 32;    // then it is known well enough
enum : size_t { PLAIN, METHOD };         // Correlator::subjects()

class CorrelationStudy : public Study
{
  public:
    explicit CorrelationStudy(const Subject& subject)
        : side_(subject.side), method_{"", small(subject.settings)},
          correlator_(siblingOf(subject, passes::emissionSettings(method_.settings)), method_.settings, {method_})
    {
        // The path tracer's law alone is enough where it is the method's.
        const passes::Settings& s = method_.settings;
        first_ = passes::lawHolds(s, correlator_.sameView()) && passes::accumulates(s) ? PLAIN : METHOD;
        begin(first_);
    }

    bool step(Findings& findings) override
    {
        const bool news = correlator_.step();
        std::vector<passes::CorrelationBatch> batches;
        if (news) {
            batches = finished_;
            batches.push_back(correlator_.batch());
        }
        if (correlator_.complete()) {
            finished_.push_back(correlator_.batch());
            if (subject_ == METHOD) ++complete_;
            begin(subject_ == METHOD ? first_ : METHOD);
        }
        if (!news) return false;
        passes::Correlation all{.sameView = correlator_.sameView()};
        evaluate(all, {method_}, std::move(batches));
        passes::Curve& curve = all.curves.front();
        std::erase_if(curve.points, [](const passes::CurvePoint& point) { return point.runs == 0; });
        findings.curves[side_] = std::make_shared<const CorrelationCurve>(
            CorrelationCurve{std::move(curve), complete_, method_.settings.width, method_.settings.height, RUNS});
        return true;
    }
    bool done() const override { return complete_ >= MOST_BATCHES; }

  private:
    static passes::Settings small(passes::Settings settings)
    {
        const double pixels = double(settings.width) * settings.height;
        const double scale = std::min(1.0, std::sqrt(CHAIN_PIXELS / pixels));
        settings.width = std::max(uint32_t(scale * settings.width), 1u);
        settings.height = std::max(uint32_t(scale * settings.height), 1u);
        settings.frames = LONGEST_CHAIN;
        settings.average = false;
        return settings;
    }

    void begin(size_t subject)
    {
        subject_ = subject;
        correlator_.begin(subject, complete_, RUNS);
    }

    Side side_;
    passes::NamedMethod method_;
    passes::Correlator correlator_;
    size_t first_ = METHOD, subject_ = METHOD; // of a batch; now
    std::vector<passes::CorrelationBatch> finished_;
    uint32_t complete_ = 0; // batches of the method
};

// -------------------------------------------------------------------------------------------------------------- floor

constexpr uint32_t FIRST_FLOOR = 4, MOST_FLOOR = 4096; // frames: when it is first shown, when it is known well enough

class FloorStudy : public Study
{
  public:
    explicit FloorStudy(const Subject& subject) : side_(subject.side), settings_(passes::lawSettings(subject.settings))
    {
        if (passes::accumulates(subject.settings)) return; // there is none
        settings_.seed = ~settings_.seed;
        const auto emitters = siblingOf(subject, passes::emissionSettings(settings_));
        emitters->renderFrame();
        renderer_ = siblingOf(subject, settings_);
        meter_.emplace(*renderer_, emitters->read(passes::LAST_FRAME));
    }

    bool step(Findings& findings) override
    {
        Floor floor{.deviation = {.width = settings_.width, .height = settings_.height}};
        if (meter_) {
            meter_->step();
            floor.frames = meter_->frames();
            if (floor.frames < FIRST_FLOOR || floor.frames < GROWTH * shown_) return false;
            for (const glm::dvec3& p : meter_->law().floor)
                floor.deviation.pixels.emplace_back(
                    glm::sqrt(glm::max(p, glm::dvec3(0)))); // 0 is estimated as below, too
        } else {
            floor.deviation.pixels.resize(size_t{settings_.width} * settings_.height);
        }
        shown_ = floor.frames;
        done_ = !meter_ || shown_ >= MOST_FLOOR;
        findings.floors[side_] = std::make_shared<const Floor>(std::move(floor));
        return true;
    }
    bool done() const override { return done_; }

  private:
    Side side_;
    passes::Settings settings_;
    std::unique_ptr<passes::Renderer> renderer_;
    std::optional<passes::LawMeter> meter_; // empty: every channel has a reservoir of its own
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
          everything_(std::make_unique<passes::Renderer>(
              subject.like.device(), subject.scene, subject.settings,
              passes::SceneOptions{.featureSet = scene::FeatureSet::Everything, .moves = subject.like.scene().moves()}))
    {
        if (const std::optional<double> seconds = subject.like.sceneSeconds())
            everything_->setScene(subject.scene, *seconds);
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

// -------------------------------------------------------------------------------------------------------------- kinds

template <class Kind>
std::unique_ptr<Study> make(const Subject& subject)
{
    return std::make_unique<Kind>(subject);
}

std::unique_ptr<Study> makeCorrelation(const Subject& subject)
{
    const bool history = subject.settings.method != passes::Method::Pt && subject.settings.maxConfidence >= 2;
    return history ? make<CorrelationStudy>(subject) : nullptr;
}

} // namespace

const StudyKind STUDY_KINDS[] = {
    {false, true, [](const StudyOrder& order) { return uint64_t{order.reference}; }, make<ReferenceStudy>,
     [](Findings& findings, Side) { findings.reference.reset(); }},
    {true, false, [](const StudyOrder& order) { return uint64_t{order.correlation}; }, makeCorrelation,
     [](Findings& findings, Side side) { findings.curves[side].reset(); }},
    {true, false, [](const StudyOrder& order) { return uint64_t{order.floor}; }, make<FloorStudy>,
     [](Findings& findings, Side side) { findings.floors[side].reset(); }},
    {false, false, [](const StudyOrder& order) { return order.savings; }, make<SavingsStudy>,
     [](Findings& findings, Side) { findings.savings.reset(); }}};

} // namespace ui
