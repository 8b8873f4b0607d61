#pragma once
// The paper's experiment: how strongly the frames M-1 and M of temporal reuse depend on each other, over independent
// runs, and what the closed form says about it (docs/DECISIONS.md, "Measuring").

#include <array>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "engine/base/batches.h"
#include "passes/renderer.h"
#include "passes/sequence.h"

namespace passes
{

// Frames that lie further apart than the last two.
struct LagPoint {
    uint32_t lag = 0;                      // frames
    statistics::BatchValue autocovariance; // of the frames M - lag and M, radiance^2
    bool operator==(const LagPoint&) const = default;
};
constexpr uint32_t MAX_LAG = 64;

// Frames M-1 and M of a batch of runs, averaged over pixels and channels.
struct ChainPoint {
    uint32_t frame = 0;                         // M, counted from 1
    uint64_t pixels = 0;                        // of one run, that counted
    statistics::BatchValue autocovariance;      // radiance^2
    statistics::BatchValue variance;            // of frame M alone, radiance^2
    std::optional<statistics::BatchValue> film; // variance of the mean of the frames 1 .. M; none where something moves
    std::vector<LagPoint> lags;                 // 2, 4, 8 ... up to M / 2 and MAX_LAG
    bool operator==(const ChainPoint&) const = default;
};

// Takes the points M = 2, 4, 8, ... of a renderer's runs, frame by frame: all from one chain, since M_c >= M does not
// bind before. Where something moves a pixel of frame M pairs with the one that saw the same point in the earlier
// frame; pixels without one do not count.
class Chain
{
  public:
    explicit Chain(Renderer& renderer, Sequence sequence = {}); // starts over
    void step();                                                // renders the next frame
    uint32_t frame() const { return frame_; }                   // the last one, counted from 1
    const std::vector<ChainPoint>& points() const { return points_; }

  private:
    Renderer& renderer_;
    Sequence sequence_;
    // A frame that a later one will be compared with, and the pixel of it that saw what each pixel sees by now.
    struct Held {
        uint32_t frame;
        image::Image picture;
        std::vector<uint32_t> pixels; // shared::NO_NEIGHBOR: none
    };
    void follow(); // the held frames' pixels, into this frame
    void take();   // this frame's point
    uint32_t frame_ = 0;
    std::vector<Held> held_;
    std::vector<ChainPoint> points_;
};

// Single frames without reuse, of a batch of runs: what the law of the chain is made of.
struct FrameLaw {
    statistics::BatchValue variance; // of a frame's color, mean over pixels and channels: sigma^2 for the path tracer
    statistics::BatchValue plateau;  // P, likewise: what is left of the autocovariance however long the history is
    std::vector<glm::dvec3> floor;   // P by pixel and channel
    std::vector<glm::dvec3> mean;    // color, without what is seen directly
    bool operator==(const FrameLaw&) const = default;
};

// Measures it on a renderer of lawSettings(), frame by frame. `emission` is what each pixel sees directly (one run's
// picture): no part of what is resampled.
class LawMeter
{
  public:
    LawMeter(Renderer& renderer, image::Image emission); // starts over
    void step();                                         // renders the next frame
    uint32_t frames() const { return frames_; }
    FrameLaw law() const; // needs two frames; below three runs there is nothing to leave out (`without` is empty)

  private:
    // Of one channel of one pixel in one run. C: the color; s: the weight sum that it is drawn with; E[C^2 / s] is
    // E[q], with q the mean of f_c^2 / p_hat over a tree's paths: C^2 / s has that mean given the tree.
    struct Sums {
        double color = 0, weight = 0, ratio = 0; // running means
        double square = 0;                       // sum of squared deviations of C

        void add(double c, double s, double n);
        double plateau(double n) const; // P from the means of n values
    };
    Renderer& renderer_;
    size_t runs_;
    std::array<glm::vec3, 3> targets_; // [c]: of the reservoir that channel c is resolved from
    image::Image emission_;
    uint32_t frames_ = 0;
    std::vector<Sums> sums_; // run by run, pixel by pixel, by channel
};

// Of the single frames that the law of these settings is made of: without reuse, and showing the chosen samples.
Settings lawSettings(Settings settings);

// Of the picture of what each pixel sees directly.
Settings emissionSettings(Settings settings);

// Whether the law of the chain holds: temporal reuse alone, every pixel seeing the same point in each frame (the camera
// rests, and SceneOnDevice::viewRepeats()).
bool lawHolds(const Settings& settings, bool sameView);

// Whether every channel is estimated for itself, by a reservoir of its own or beside one (Color::Variate), so that a
// resting camera's chain is the mean of the path tracer's frames.
bool accumulates(const Settings& settings);

// The autocovariance between frames n = M - lag and M <= M_c + 1 that the law predicts, for each way of reading color:
// of chosen samples V / M + (n - 1) / M P; of all with their weights V / M + (n - 1) / M (1 - 2 / n) P, where the first
// frame shows whole trees, so that for n = 1 the law of the path tracer is to be given.
statistics::BatchValue predictedAutocovariance(const FrameLaw& law, Color color, double frame, double lag = 1);

// The variance of the mean of the frames 1 .. M, of chosen samples: about 2 V / M + P / 2 for large M.
statistics::BatchValue predictedFilm(const FrameLaw& law, uint32_t frame);

} // namespace passes
