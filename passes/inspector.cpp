#include "passes/inspector.h"

namespace passes
{

Inspector::Inspector(Renderer& renderer)
    : renderer_(renderer),
      request_(renderer.device().createBuffer({.label = "Request", .size = sizeof(shared::PathRequest)}))
{
}

void Inspector::prepare(Tool& tool, const char* stage, const char* result, uint64_t bytes, gpu::Usage usage)
{
    if (tool.stage) return;
    tool.result =
        renderer_.device().createBuffer({.label = result, .size = bytes, .usage = usage, .setting = "--size"});
    tool.stage = renderer_.makeStage(stage, renderer_.variant(), {{result, &tool.result}, {"Request", &request_}});
}

void Inspector::run(const Tool& tool, gpu::Threads threads)
{
    renderer_.wait();
    gpu::Device& device = renderer_.device();
    gpu::CommandEncoder encoder = device.createCommandEncoder("inspect");
    tool.stage->encode(encoder, threads);
    device.queue().wait(device.queue().submit(std::move(encoder)));
}

std::vector<shared::Inspection> Inspector::reservoirs()
{
    const Settings& settings = renderer_.settings();
    if (settings.method == Method::Pt) return {};
    const uint64_t pixels = uint64_t{settings.width} * settings.height;
    prepare(reservoirs_, "inspect", "Inspections",
            pixels * renderer_.variant().RESERVOIR_COUNT * sizeof(shared::Inspection));
    run(reservoirs_, {settings.width, settings.height});
    return renderer_.device().queue().readAs<shared::Inspection>(reservoirs_.result);
}

std::vector<ShiftCounts> Inspector::shifts()
{
    const Settings& settings = renderer_.settings();
    if (settings.method == Method::Pt || settings.spatial == 0) return {};
    const uint64_t pixels = uint64_t{settings.width} * settings.height;
    constexpr size_t WORDS = 8; // of a pixel and slot: the outcomes, in two rows
    prepare(shifts_, "inspect_shifts", "ShiftCounts", pixels * settings.spatial * WORDS * sizeof(uint32_t));
    run(shifts_, {settings.width, settings.height, settings.spatial});
    const std::vector<uint32_t> words = renderer_.device().queue().readAs<uint32_t>(shifts_.result);
    std::vector<ShiftCounts> counts(pixels, ShiftCounts{});
    for (size_t i = 0; i < words.size(); ++i)
        if (i % WORDS < shared::SHIFT_OUTCOMES) counts[i / WORDS % pixels][i % WORDS] += words[i];
    return counts;
}

std::vector<std::vector<shared::PathPoint>> Inspector::paths(uint32_t pixel)
{
    const Variant variant = renderer_.variant();
    const size_t points = variant.MAX_BOUNCES + 1; // as in the shader
    prepare(paths_, "inspect_path", "PathPoints", variant.RESERVOIR_COUNT * points * sizeof(shared::PathPoint),
            gpu::Usage::Storage);
    const bool plain = renderer_.settings().method == Method::Pt;
    renderer_.device().queue().writeValue(request_, shared::PathRequest{.pixel = pixel, .plain = plain});
    run(paths_, {variant.RESERVOIR_COUNT});
    const auto all = renderer_.device().queue().readAs<shared::PathPoint>(paths_.result);
    std::vector<std::vector<shared::PathPoint>> paths(variant.RESERVOIR_COUNT);
    for (size_t c = 0; c < paths.size(); ++c)
        for (size_t i = c * points; i < (c + 1) * points && all[i].kind != shared::POINT_NONE; ++i)
            paths[c].push_back(all[i]);
    return paths;
}

} // namespace passes
