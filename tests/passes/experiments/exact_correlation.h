#pragma once
// What `correlate` would measure without any error: sigma^2 = 8, V = 10, P = 0.1, to M = 4.

#include "passes/experiments/correlation.h"

namespace support
{

inline statistics::BatchValue about(double value)
{
    return {.value = value, .without = {0.99 * value, value, 1.01 * value}};
}

inline passes::FrameLaw law(double variance, double plateau)
{
    return {.variance = about(variance),
            .plateau = plateau > 0 ? about(plateau) : statistics::BatchValue{.value = 0, .without = {0, 0, 0}},
            .floor = {glm::dvec3(plateau), glm::dvec3(plateau / 3)},
            .mean = {glm::dvec3(1), glm::dvec3(1.0 / 7)}};
}

inline std::vector<passes::NamedMethod> methods(uint32_t maxConfidence, passes::Color color = passes::Color::Chosen)
{
    passes::Settings settings;
    settings.temporal = true;
    settings.spatial = 0;
    settings.maxConfidence = maxConfidence;
    settings.color = color;
    passes::Settings each = settings;
    settings.method = passes::Method::RestirPt;
    each.method = passes::Method::RgbRestir;
    return {{"restir-pt", settings}, {"rgb-restir", each}};
}

inline std::vector<passes::CorrelationBatch> exact(uint32_t index)
{
    passes::CorrelationBatch plain{.method = passes::PATH_TRACER, .index = index, .runs = 3, .law = law(8, 0)};
    passes::CorrelationBatch one{.method = "restir-pt", .index = index, .runs = 3, .law = law(10, 0.1)};
    passes::CorrelationBatch each{.method = "rgb-restir", .index = index, .runs = 3};
    for (const uint32_t frame : {2u, 4u}) {
        one.points.push_back({frame, 2, about(10.0 / frame + (1 - 2.0 / frame) * 0.1), about(6), about(5.5), {}});
        each.points.push_back({frame, 2, about(8.0 / frame), about(5), std::nullopt, {}});
        if (frame == 4) each.points.back().lags = {{2, about(8.0 / frame)}};
    }
    return {plain, one, each};
}

inline passes::Correlation evaluated(uint32_t maxConfidence)
{
    passes::Correlation correlation{.scene = "a <scene>", .width = 2, .height = 1, .runs = 6};
    std::vector<passes::CorrelationBatch> batches = exact(0);
    for (const passes::CorrelationBatch& batch : exact(1)) batches.push_back(batch);
    evaluate(correlation, methods(maxConfidence), batches);
    return correlation;
}

} // namespace support
