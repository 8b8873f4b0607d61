#include "tests/support/toy_world.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "passes/variant.h"
#include "shaders/shared/frame.h"
#include "shaders/shared/rows.h"
#include "tests/shaders/toy/toy.h"

namespace support
{

namespace
{

using shared::ToyDomain;

constexpr uint32_t SIZE = 16;                           // pixels of a run, in both directions
constexpr uint32_t PERIOD = 8;                          // frames, after which what moves comes again
constexpr uint32_t NEIGHBORS = 2;                       // K
constexpr uint32_t TILE = 4;                            // pixels
constexpr uint32_t MANY_RUNS = 2048, LOOKS_AT_MANY = 8; // so many are rendered in so many batches, as far as needed
constexpr glm::vec3 EMISSION(0.5f, 0.25f, 0.125f);      // as in candidates.glsl

// Colors of the paths' cells: each channel is dark somewhere.
const glm::vec4 CELLS[shared::TOY_PATHS][shared::TOY_CELLS] = {
    {{1, 1, 1, 0}, {0, 1.2f, 0.8f, 0}, {1.1f, 0, 1, 0}, {0.9f, 0.8f, 0, 0}},
    {{0.8f, 1, 1.2f, 0}, {1, 1, 1, 0}, {1.5f, 0, 0, 0}, {0, 0.7f, 1.3f, 0}},
};

float fraction(double x)
{
    return float(x - std::floor(x));
}

ToyDomain domainAt(uint32_t x, uint32_t y, uint32_t frame, bool moves)
{
    const uint32_t n = moves ? frame % PERIOD : 0;
    // Alike within a tile, so that the errors of its domains do not cancel.
    const uint32_t tile = y / TILE * (SIZE / TILE) + x / TILE, within = (5 * (x % TILE) + 3 * (y % TILE)) % 16;
    const float t = fraction((tile + within / 16.0) / 16 + 0.07 * n);
    ToyDomain d = {};
    d.albedo = {t >= 0.5f && t < 0.65f ? 0 : 0.6f + 0.4f * fraction(3 * t), t >= 0.8f && t < 0.9f ? 0 : 0.5f + 0.5f * t,
                t < 0.12f ? 0 : 0.9f - 0.3f * t, 0};
    d.slope = 0.45f + 0.35f * std::sin(2 * std::numbers::pi_v<float> * t);
    d.occluder = 0.1f + 0.6f * fraction(1.7 * t + 0.2);
    d.phase = fraction(2.3 * t);
    d.likeness = t;
    d.seen = (x + 3 * y + n) % 13 != 0;
    d.previousPixel = !moves ? y * SIZE + x : (7 * x + y) % 19 == 0 ? shared::NO_NEIGHBOR : y * SIZE + (x + 1) % SIZE;
    return d;
}

double integralOfEnding(double from, double to) // of 1 + 2 x
{
    return to > from ? (to - from) + (to * to - from * from) : 0;
}

glm::dvec3 integral(const ToyDomain& d)
{
    if (d.seen == 0) return glm::dvec3(0);
    const double low = d.occluder - shared::TOY_OCCLUDER_SIZE, high = d.occluder + shared::TOY_OCCLUDER_SIZE;
    glm::dvec3 sum(0);
    for (const auto& path : CELLS)
        for (uint32_t i = 0; i < shared::TOY_CELLS; ++i) {
            const double from = double(i) / shared::TOY_CELLS, to = double(i + 1) / shared::TOY_CELLS;
            const double seen = integralOfEnding(from, std::min(to, low)) + integralOfEnding(std::max(from, high), to);
            sum += glm::dvec3(d.albedo) * glm::dvec3(path[i]) * seen;
        }
    return sum;
}

// In frame `frame`, exactly.
PixelEstimates integrals(uint32_t frame, bool moves)
{
    PixelEstimates picture{SIZE, SIZE, {}};
    for (uint32_t y = 0; y < SIZE; ++y)
        for (uint32_t x = 0; x < SIZE; ++x) {
            const glm::dvec3 i = integral(domainAt(x, y, frame, moves));
            const auto exactly = [](double mean) {
                return statistics::Estimate{mean, 0, std::numeric_limits<double>::infinity()};
            };
            picture.pixels.push_back({exactly(i.r), exactly(i.g), exactly(i.b)});
        }
    return picture;
}

std::vector<std::byte> domainBytes(bool moves)
{
    std::vector<ToyDomain> domains;
    for (uint32_t frame = 0; frame < PERIOD; ++frame)
        for (uint32_t y = 0; y < SIZE; ++y)
            for (uint32_t x = 0; x < SIZE; ++x) domains.push_back(domainAt(x, y, frame, moves));
    const uint32_t header[4] = {PERIOD};
    std::vector<std::byte> bytes(sizeof(CELLS) + sizeof(header) + std::span(domains).size_bytes());
    auto end = bytes.begin();
    const auto append = [&](std::span<const std::byte> more) { end = std::ranges::copy(more, end).out; };
    append(std::as_bytes(std::span(CELLS)));
    append(std::as_bytes(std::span(header)));
    append(std::as_bytes(std::span(domains)));
    return bytes;
}

} // namespace

std::string ToyCase::name() const
{
    constexpr const char* REUSES[] = {"temporal", "spatial", "both"};
    return std::string(REUSES[size_t(reuse)]) + (moves ? ", moving" : ", resting") +
           ", M_c = " + std::to_string(maxConfidence);
}

ToyRenderer::ToyRenderer(gpu::Device& device, const std::string& shaders, const passes::Estimator& estimator,
                         passes::Shift shift, uint32_t runs, passes::Color color, passes::Mutate mutate)
    : device_(device), shaders_(shaders), estimator_(estimator), runs_(runs), mutates_(mutate != passes::Mutate::Off)
{
    passes::checkUnbiased(estimator);
    CHECK_EQ(runs % shared::TOY_GROUP, 0u);
    passes::Variant variant;
    variant.RESERVOIR_COUNT = uint32_t(estimator.target.size());
    variant.SHIFT_MAP = uint32_t(shift);
    variant.COLOR_READING = uint32_t(color);
    variant.ONE_CHANNEL = passes::oneHot(estimator);
    variant.MUTATION = uint32_t(mutate);
    constants_ = passes::constants(variant);

    const uint64_t pixels = uint64_t{runs} * SIZE * SIZE;
    const uint32_t count = uint32_t(estimator.target.size());
    const auto add = [&](const char* name, uint64_t size, gpu::Usage usage = gpu::Usage::Storage | gpu::Usage::Table) {
        buffers_.emplace(name, device.createBuffer({.label = name, .size = size, .usage = usage}));
    };
    add("Frame", sizeof(shared::FrameUniform), gpu::Usage::Uniform);
    add("Counters", 2 * sizeof(uint32_t) * shared::COUNTER_COUNT);
    add("Domains", domainBytes(false).size());
    const bool one = variant.ONE_CHANNEL, densities = mutates_ && shift != passes::Shift::Replay;
    for (const char* set : {"Reservoirs", "History"}) add(set, pixels * shared::headRows(count, one, densities) * 16);
    for (const char* set : {"ReservoirPaths", "HistoryPaths"}) add(set, pixels * count * shared::pathRows(one) * 16);
    for (const char* words : {"Confidences", "HistoryConfidences"}) add(words, pixels * sizeof(uint32_t));
    add("Shifted", pixels * NEIGHBORS * shared::slotRows(count, one, densities) * 16);
    add("Color", pixels * 16);
    add("MergedColor", pixels * 16);
    add("HistoryColor", pixels * 16);
}

ToyRenderer::Stage& ToyRenderer::stage(const std::string& name, bool sameView)
{
    const auto found = stages_.find({name, sameView});
    if (found != stages_.end()) return found->second;
    std::vector<gpu::Constant> constants = constants_;
    for (gpu::Constant& constant : constants)
        if (constant.name == "SAME_VIEW") constant.value = sameView;
    Stage made;
    made.pipeline = device_.createComputePipeline({.label = name, .shader = shaders_ + name, .constants = constants});
    const auto group = [&](uint32_t set) {
        gpu::BindGroupDescriptor d{.label = name, .pipeline = &made.pipeline, .set = set};
        for (const gpu::Binding& binding : made.pipeline.bindings())
            if (binding.set == set) d.buffers.emplace_back(binding.name, &buffers_.at(binding.name));
        return device_.createBindGroup(d);
    };
    made.frame = group(SET_FRAME);
    made.own = group(SET_PASS);
    return stages_.emplace(std::pair(name, sameView), std::move(made)).first->second;
}

std::vector<image::Image> ToyRenderer::render(const ToyCase& c, bool elides)
{
    const uint32_t runs = std::min(c.runs, runs_);
    shared::FrameUniform frame = {};
    frame.width = SIZE;
    frame.height = SIZE * runs;
    frame.runHeight = SIZE;
    frame.key0 = uint32_t(c.seed * 0x9e3779b9u);
    frame.key1 = uint32_t(c.seed >> 32) ^ 0x5bd1e995u;
    frame.maxConfidence = c.maxConfidence;
    frame.colorConfidence = c.colorConfidence;
    frame.neighborCount = c.reuse == Reuse::Temporal ? 0 : NEIGHBORS;
    frame.neighborRadius = 3;
    for (size_t i = 0; i < estimator_.target.size(); ++i) {
        frame.target[i] = glm::vec4(estimator_.target[i], 0);
        frame.resolve[i] = glm::vec4(estimator_.resolve[i], 0);
    }
    device_.queue().write(buffers_.at("Domains"), domainBytes(c.moves));
    for (; frame.frame < c.frames; ++frame.frame) {
        device_.queue().writeValue(buffers_.at("Frame"), frame);
        gpu::CommandEncoder encoder = device_.createCommandEncoder("frame");
        if (frame.frame == 0) encoder.clear(buffers_.at("Counters"));
        const auto encode = [&](const char* name, uint32_t perPixel = 1, bool sameView = false) {
            Stage& s = stage(name, sameView);
            encoder.dispatch({.pipeline = &s.pipeline,
                              .groups = {&s.frame, nullptr, &s.own},
                              .threads = {SIZE * perPixel, SIZE * runs}});
        };
        const bool merges = c.reuse != Reuse::Spatial && frame.frame > 0, sameView = !c.moves && elides;
        encode("canonical", 1, mutates_ && merges && sameView);
        if (mutates_ && merges && !sameView) encode("mutate");
        if (merges) encode("temporal", 1, sameView);
        if (c.reuse != Reuse::Temporal) encode("spatial_trace", NEIGHBORS);
        encode("spatial_gather");
        device_.queue().submit(std::move(encoder));
    }
    const std::vector<uint32_t> counters = device_.queue().readAs<uint32_t>(buffers_.at("Counters"));
    for (uint32_t i = 0; i < shared::STAGE_COUNT; ++i)
        EXPECT_EQ(counters[size_t{2} * (shared::COUNTER_NONFINITE + i)], 0u);

    const std::vector<glm::vec4> color = device_.queue().readAs<glm::vec4>(buffers_.at("Color"));
    constexpr size_t PIXELS = size_t{SIZE} * SIZE;
    std::vector<image::Image> pictures(runs / shared::TOY_GROUP, {SIZE, SIZE, std::vector<glm::vec3>(PIXELS)});
    for (size_t i = 0; i < runs * PIXELS; ++i)
        pictures[i / PIXELS / shared::TOY_GROUP].pixels[i % PIXELS] +=
            (glm::vec3(color[i]) - EMISSION) / float(shared::TOY_GROUP);
    return pictures;
}

TileVerdict ToyRenderer::verdict(const ToyCase& c, double level, double margin)
{
    const PixelEstimates expected = integrals(c.frames - 1, c.moves);
    const TileEstimates expectedTiles = tilesOf(expected, TILE), expectedWhole = tilesOf(expected, SIZE);
    // As RestirCase::verdict() looks: after 1, 2, 4 ... batches, each look with its share of the levels, until
    // something differs, or all of it is known well enough.
    const uint32_t runs = std::min(c.runs, runs_), batches = runs >= MANY_RUNS ? LOOKS_AT_MANY : 1;
    const double share = 1.0 / (std::bit_width(batches - 1) + 1);
    TileRuns tiles(TILE), whole(SIZE);
    ToyCase part = c;
    part.runs = runs / batches / shared::TOY_GROUP * shared::TOY_GROUP;
    for (uint32_t batch = 1;; ++batch) {
        for (const image::Image& picture : render(part)) {
            tiles.add(picture);
            whole.add(picture);
        }
        part.seed += 1000003; // not the next one, which other cases have
        if (!std::has_single_bit(batch)) continue;
        const TileVerdict byTile = tilesAgree(tiles.estimates(), expectedTiles, level * share);
        const TileVerdict agree = tilesAgree(whole.estimates(), expectedWhole, level * share);
        const TileVerdict equal = tilesAreEquivalent(whole.estimates(), expectedWhole, margin, 0.05 * share);
        const bool known =
            equal.passes && tilesAreEquivalent(tiles.estimates(), expectedTiles, 2 * margin, 0.05 * share).passes;
        if (byTile.passes && agree.passes && !known && batch < batches) continue;
        return {byTile.passes && agree.passes && equal.passes,
                "tiles: " + byTile.summary + "\nwhole: " + agree.summary + "\nwithin the margin: " + equal.summary};
    }
}

} // namespace support
