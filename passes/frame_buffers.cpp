#include "passes/frame_buffers.h"

#include "passes/estimator.h"
#include "shaders/shared/rows.h"

#include <algorithm>
#include <numeric>

namespace passes
{

namespace
{

constexpr uint64_t ROW = sizeof(glm::uvec4), WORD = sizeof(uint32_t);
constexpr gpu::Usage WORDS = gpu::Usage::Storage | gpu::Usage::Table; // written word by word, read as rows

} // namespace

std::vector<PixelBuffer> pixelBuffers(const Settings& settings)
{
    const bool resamples = settings.method != Method::Pt;
    const uint32_t count = resamples ? uint32_t(estimatorOf(settings.method).target.size()) : 0;
    const bool one = resamples && oneHot(estimatorOf(settings.method));
    const bool densities = settings.mutate != Mutate::Off && settings.shift != Shift::Replay;
    const uint64_t heads = resamples ? uint64_t{shared::headRows(count, one, densities)} * ROW : 0;
    const uint64_t paths = settings.shift == Shift::Replay ? 0 : uint64_t{count} * shared::pathRows(one) * ROW;
    const uint64_t confidence = resamples ? WORD : 0;
    const uint64_t shifted = resamples ? uint64_t{settings.spatial} * shared::slotRows(count, one, densities) * ROW : 0;
    const uint64_t merged = colorReading(settings) != Color::Chosen ? ROW : 0;
    const uint64_t variate = colorReading(settings) == Color::Variate ? ROW : 0;
    return {
        {.name = "Surfaces", .bytes = shared::SURFACE_ROWS * ROW, .lasts = resamples},
        {.name = "Color", .bytes = shared::COLOR_ROWS * ROW, .lasts = true},
        {.name = "Film", .bytes = shared::FILM_ROWS * ROW, .lasts = true},
        {.name = "Reservoirs", .bytes = heads},
        {.name = "ReservoirPaths", .bytes = paths, .blame = "--size or --shift"},
        {.name = "Confidences", .bytes = confidence, .usage = WORDS},
        {.name = "History", .bytes = heads, .lasts = resamples},
        {.name = "HistoryPaths", .bytes = paths, .lasts = resamples, .blame = "--size or --shift"},
        {.name = "HistoryConfidences", .bytes = confidence, .lasts = resamples, .usage = WORDS},
        {.name = "Shifted", .bytes = shifted, .blame = "--size or --spatial"},
        {.name = "MergedColor", .bytes = merged, .blame = "--size or --color"},
        {.name = "HistoryColor", .bytes = variate, .lasts = variate > 0, .blame = "--size or --color"},
    };
}

uint64_t bytesPerPixel(const Settings& settings)
{
    const std::vector<PixelBuffer> rows = pixelBuffers(settings);
    return std::accumulate(rows.begin(), rows.end(), uint64_t{0},
                           [](uint64_t sum, const PixelBuffer& row) { return sum + row.bytes; });
}

double bytesPerReservoir(const Settings& settings)
{
    if (settings.method == Method::Pt) return 0;
    double sum = 0;
    for (const PixelBuffer& row : pixelBuffers(settings))
        for (const char* set : {"Reservoir", "Confidences", "History"})
            if (std::string_view(row.name).starts_with(set)) sum += double(row.bytes);
    return sum / double(estimatorOf(settings.method).target.size());
}

uint32_t maxRuns(const gpu::Limits& limits, const Settings& settings)
{
    constexpr uint64_t MOST_LINES = uint64_t{65535} * 8; // of a picture: workgroups along an axis that any device takes
    const uint64_t pixels = uint64_t{settings.width} * settings.height;
    uint64_t most = std::min(limits.memoryBytes / 4 / bytesPerPixel(settings), uint64_t{UINT32_MAX});
    for (const PixelBuffer& row : pixelBuffers(settings)) {
        const uint64_t limit = has(row.usage, gpu::Usage::Storage)
                                   ? std::min(limits.storageBindingBytes, limits.tableBytes)
                                   : limits.tableBytes;
        most = std::min(most, limit / std::max<uint64_t>(row.bytes, 1));
    }
    return uint32_t(std::min(most / pixels, MOST_LINES / settings.height));
}

bool fitStorageBindings(const gpu::Limits& limits, const Settings& settings, uint32_t runs)
{
    const uint64_t pixels = uint64_t{settings.width} * settings.height * runs;
    return std::ranges::all_of(pixelBuffers(settings), [&](const PixelBuffer& row) {
        return row.bytes * pixels <= limits.storageBindingBytes;
    });
}

FrameBuffers::FrameBuffers(gpu::Device& device, const Settings& settings, uint32_t runs) : rows_(pixelBuffers(settings))
{
    const uint64_t pixels = uint64_t{settings.width} * settings.height * runs;
    for (const PixelBuffer& row : rows_) // one of 16 bytes, too, where this method does not use what its stages declare
        buffers_.push_back(
            device.createBuffer({.label = row.name,
                                 .size = std::max<uint64_t>((pixels * row.bytes + ROW - 1) / ROW, 1) * ROW,
                                 .usage = row.usage,
                                 .setting = row.blame}));
}

const gpu::Buffer& FrameBuffers::operator[](std::string_view name) const
{
    const auto row = std::ranges::find(rows_, name, &PixelBuffer::name);
    return buffers_.at(size_t(row - rows_.begin()));
}

NamedBuffers FrameBuffers::named() const
{
    NamedBuffers list;
    for (size_t i = 0; i < rows_.size(); ++i) list.emplace_back(rows_[i].name, &buffers_[i]);
    return list;
}

std::vector<const gpu::Buffer*> FrameBuffers::lasting() const
{
    std::vector<const gpu::Buffer*> list;
    for (size_t i = 0; i < rows_.size(); ++i)
        if (rows_[i].lasts) list.push_back(&buffers_[i]);
    return list;
}

} // namespace passes
