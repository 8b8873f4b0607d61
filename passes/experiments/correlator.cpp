#include "passes/experiments/correlator.h"

#include "engine/base/check.h"

#include <algorithm>

namespace passes
{

namespace
{

constexpr uint32_t MIN_LAW_FRAMES = 64;              // of a run
constexpr uint32_t LAW_SHARE = 4;                    // single frames for the law: a quarter of the chain's
constexpr uint64_t NEXT_BATCH = 0x9e3779b97f4a7c15u; // between seeds
constexpr uint64_t LAW_SEED = 0x5851f42d4c957f2du;   // the law's random numbers are none of the chain's

} // namespace

uint32_t lastFrame(const Settings& settings)
{
    return std::min(settings.frames, settings.maxConfidence);
}

Correlator::Correlator(std::unique_ptr<Renderer> emitters, const Settings& base,
                       const std::vector<NamedMethod>& methods, Sequence sequence)
    : sequence_(std::move(sequence)), emitters_(std::move(emitters)),
      sameView_(!sequence_.moves() && emitters_->scene().viewRepeats(base)), renderers_(1 + methods.size())
{
    sequence_.bring(*emitters_, 0);
    emitters_->renderFrame();
    emission_ = emitters_->read(LAST_FRAME);

    subjects_.push_back({.name = PATH_TRACER, .settings = base});
    subjects_.front().settings.method = Method::Pt;
    for (const NamedMethod& method : methods) {
        const Settings& settings = method.settings;
        const uint32_t frames = std::max(MIN_LAW_FRAMES, lastFrame(settings) / LAW_SHARE);
        const bool own = lawHolds(settings, sameView_) && !accumulates(settings);
        subjects_.push_back({method.name, settings, own ? frames : 0, lastFrame(settings)});
        subjects_.front().lawFrames = std::max(subjects_.front().lawFrames, frames); // as many as the longest
    }
}

void Correlator::begin(size_t subject, uint32_t index, uint32_t runs)
{
    CHECK_LE(3u, runs);
    meter_.reset();
    chain_.reset();
    subject_ = subject;
    batch_ = {.method = subjects_[subject].name, .index = index, .runs = runs};
    std::unique_ptr<Renderer>& renderer = renderers_[subject];
    if (renderer && renderer->runs() == runs) return;
    renderer.reset(); // first: memory
    renderer = std::make_unique<Renderer>(*emitters_, subjects_[subject].settings, runs);
}

bool Correlator::step()
{
    const Subject& subject = subjects_[subject_];
    Renderer& renderer = *renderers_[subject_];
    Settings settings = subject.settings;
    settings.seed += batch_.index * NEXT_BATCH;
    if (subject.lawFrames > 0 && !batch_.law) {
        if (!meter_) {
            settings = lawSettings(settings);
            settings.seed ^= LAW_SEED;
            renderer.apply(settings);
            sequence_.bring(renderer, 0);
            meter_.emplace(renderer, emission_);
        }
        meter_->step();
        if (meter_->frames() < subject.lawFrames) return false;
        batch_.law = meter_->law();
        return true;
    }
    if (!chain_) {
        if (batch_.law) batch_.nonFinite = sumOf(renderer.stats().nonFinite);
        renderer.apply(settings);
        chain_.emplace(renderer, sequence_);
    }
    chain_->step();
    if (chain_->points().size() == batch_.points.size()) return false;
    batch_.points.push_back(chain_->points().back());
    return true;
}

bool Correlator::complete() const
{
    const Subject& subject = subjects_[subject_];
    return (subject.lawFrames == 0 || batch_.law) && (chain_ ? chain_->frame() : 0) >= subject.chainFrames;
}

CorrelationBatch Correlator::batch()
{
    CorrelationBatch batch = batch_;
    batch.nonFinite += sumOf(renderers_[subject_]->stats().nonFinite);
    return batch;
}

} // namespace passes
