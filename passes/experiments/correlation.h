#pragma once
// What `correlate` measured, put together: curves, their intervals, and what the law says.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/batches.h"
#include "passes/experiments/autocovariance.h"
#include "passes/experiments/named_method.h"

namespace passes
{

// One batch of runs of one method: the law of its single frames where it was asked for, and its chain.
struct CorrelationBatch {
    std::string method; // NamedMethod::name; PATH_TRACER: the law of plain frames, without a chain
    uint32_t index = 0;
    uint32_t runs = 0;
    std::optional<FrameLaw> law;
    std::vector<ChainPoint> points;
    uint64_t nonFinite = 0; // values found not finite and counted as 0
    bool operator==(const CorrelationBatch&) const = default;
};
constexpr const char* PATH_TRACER = "pt";

struct LagEstimate {
    uint32_t lag = 0;
    statistics::Estimate autocovariance;     // radiance^2
    std::optional<statistics::Estimate> law; // predicted
};

struct CurvePoint {
    uint32_t frame = 0;                                // M
    uint32_t runs = 0;                                 // 0: not measured
    uint64_t pixels = 0;                               // of a run, mean over batches
    statistics::Estimate autocovariance;               // radiance^2
    statistics::Estimate variance;                     // of frame M
    std::optional<statistics::Estimate> law;           // predicted autocovariance
    std::optional<statistics::Estimate> film, filmLaw; // variance of the mean of all frames, measured and predicted
    std::vector<LagEstimate> lags;                     // of frames further apart
    double z() const; // measured against predicted, in standard errors; nan without either
};

struct Curve {
    NamedMethod method;
    std::vector<CurvePoint> points;              // by M: measured, then predicted alone
    std::optional<statistics::Estimate> plateau; // P
    std::vector<glm::dvec3> floor, mean;         // by pixel; empty: not measured
};

struct Correlation {
    std::string scene;
    bool moving = false;
    bool sameView = true; // every pixel sees the same point in each frame; else no law is known
    bool partial = false;
    uint32_t width = 0, height = 0;             // of one run, pixels
    uint32_t runs = 0;                          // asked for
    std::optional<statistics::Estimate> sigma2; // the path tracer's, per frame
    std::vector<Curve> curves;
    uint64_t nonFinite = 0;
};

// Fills the curves from batches, which may come in any order and twice: equal batches give equal bits.
void evaluate(Correlation& correlation, const std::vector<NamedMethod>& methods, std::vector<CorrelationBatch> batches);

// M*: where sigma^2 / M falls to P. Nothing where P is not known to be above 0.
std::optional<statistics::Interval> crossover(const Correlation& correlation, const Curve& curve);

std::string csvOf(const Correlation& correlation);

} // namespace passes
