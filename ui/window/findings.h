#pragma once
// What is known besides the pictures: the reference, and what studies of the sides have found so far.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/image/mean_picture.h"
#include "passes/experiments/correlation.h"
#include "ui/window/order.h"

namespace ui
{

struct Reference {
    image::Image picture;
    std::string name;        // for people: a file, or what was frozen
    image::OwnError error;   // its own, which errors against it have too much; 0 where it is not known
    uint64_t converging = 0; // equal for what is one path traced reference, more and more precise; 0: it stays as it is
};
using ReferencePointer = std::shared_ptr<const Reference>;

// How strongly the frames M-1 and M of a side depend on each other, as `correlate` measures it.
struct CorrelationCurve {
    passes::Curve curve;  // as far as it is measured
    uint32_t batches = 0; // that are complete
    uint32_t width = 0, height = 0, runs = 0;
};

// √P by pixel and channel: the color noise that no history removes, however long.
struct Floor {
    image::Image deviation;
    uint32_t frames = 0; // that it was estimated from; 0: known to be none
};

// What it is worth that a side's stages leave out what scene and settings do not need.
struct Savings {
    double neededMilliseconds = 0, everythingMilliseconds = 0; // of a frame, wall
    uint64_t neededBytes = 0, everythingBytes = 0;             // of the scene's tables
    uint32_t frames = 0;                                       // of each
};

struct Findings {
    ReferencePointer reference;
    std::shared_ptr<const CorrelationCurve> curves[SIDES];
    std::shared_ptr<const Floor> floors[SIDES];
    std::optional<Savings> savings;
};

} // namespace ui
