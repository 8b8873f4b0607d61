#pragma once
// Measures batches of `correlate`'s experiment, a frame a step, one after the other.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "passes/experiments/correlation.h"

namespace passes
{

class Correlator
{
  public:
    // What batches are of: the path tracer (PATH_TRACER), of which the law alone is measured, and the methods. Frames
    // of a batch; 0: no law, as it is not known or is the path tracer's, or no chain.
    struct Subject {
        std::string name;
        Settings settings;
        uint32_t lawFrames = 0, chainFrames = 0;
    };

    // `emitters`, a renderer of emissionSettings(base), lends scene and camera; `sequence` says what moves.
    Correlator(std::unique_ptr<Renderer> emitters, const Settings& base, const std::vector<NamedMethod>& methods,
               Sequence sequence = {});

    const std::vector<Subject>& subjects() const { return subjects_; } // the path tracer, then the methods
    bool sameView() const { return sameView_; }                        // as lawHolds() asks

    // The batch `index` of so many runs, at least three, each with random numbers of its own.
    void begin(size_t subject, uint32_t index, uint32_t runs);
    bool step(); // renders its next frame; true: batch() has something new, its law or a point
    bool complete() const;
    CorrelationBatch batch(); // as far as it is measured

  private:
    Sequence sequence_;
    std::unique_ptr<Renderer> emitters_;
    image::Image emission_;
    bool sameView_;
    std::vector<Subject> subjects_;
    std::vector<std::unique_ptr<Renderer>> renderers_; // by subject; null until needed

    // Of the batch at hand.
    size_t subject_ = 0;
    CorrelationBatch batch_;
    std::optional<LawMeter> meter_;
    std::optional<Chain> chain_;
};

// The last frame of the method's chain: where the cap binds, or --frames end.
uint32_t lastFrame(const Settings& settings);

} // namespace passes
