#include "tests/support/shift_lab.h"

#include <cmath>

#include <gtest/gtest.h>

#include "passes/variant.h"
#include "tests/support/test_scenes.h"

namespace support
{

namespace
{

constexpr uint32_t MAX_BOUNCES = shared::SHIFT_PATHS / 2;

shared::FrameUniform frameOf(const scene::Camera& camera, double lengthScale)
{
    const auto vector = [](const glm::dvec3& v) { return glm::vec4(glm::vec3(v), 0.0f); };
    const double half = std::tan(camera.yfov / 2);
    shared::FrameUniform frame = {};
    frame.camera = {.position = vector(camera.position * lengthScale),
                    .right = vector(camera.right * half),
                    .up = vector(camera.up * half),
                    .forward = vector(camera.forward)};
    frame.previousCamera = frame.camera;
    frame.width = frame.height = frame.runHeight = ShiftLab::SIZE;
    frame.key0 = 0x9e3779b9u;
    frame.key1 = 0x5bd1e995u;
    return frame;
}

} // namespace

ShiftLab::ShiftLab(gpu::Device& device, const std::string& kernels, passes::Shift shift)
    : device_(device), kernels_(kernels), pipelines_(device),
      frame_(
          device.createBuffer({.label = "Frame", .size = sizeof(shared::FrameUniform), .usage = gpu::Usage::Uniform})),
      counters_(device.createBuffer({.label = "Counters", .size = 2 * sizeof(uint32_t) * shared::COUNTER_COUNT})),
      surfaces_(device.createBuffer({.label = "Surfaces",
                                     .size = 2 * sizeof(glm::uvec4) * SIZE * SIZE,
                                     .usage = gpu::Usage::Storage | gpu::Usage::Table}))
{
    const scene::Scene scene = cabinet();
    const scene::SceneTables tables = scene::makeSceneTables(scene, device.limits().tableBytes);
    scene_ = std::make_unique<scene::GpuScene>(device, tables);
    passes::Settings settings;
    settings.method = passes::Method::RestirPt;
    settings.shift = shift;
    settings.maxBounces = MAX_BOUNCES;
    variant_ = passes::makeVariant(tables.features, settings, false, scene_->stack());

    device.queue().writeValue(frame_, frameOf(scene.cameras.at(0), tables.lengthScale));
    run("primary", {{"Surfaces", &surfaces_}}, {SIZE, SIZE});
    const std::vector<glm::uvec4> hits = device.queue().readAs<glm::uvec4>(surfaces_);
    for (uint32_t pixel = 0; pixel < SIZE * SIZE; ++pixel) seen_.push_back(hits[pixel].x != shared::NO_INDEX);
}

std::vector<shared::OfferedPath> ShiftLab::offered(const std::vector<shared::Tree>& trees)
{
    const gpu::Buffer asked = upload("Trees", trees);
    const std::vector<shared::OfferedPath> none(trees.size() * shared::SHIFT_PATHS);
    const gpu::Buffer found = upload("Offered", none);
    run(kernels_ + "candidates_test", {{"Surfaces", &surfaces_}, {"Trees", &asked}, {"Offered", &found}},
        {uint32_t(trees.size())});
    return device_.queue().readAs<shared::OfferedPath>(found);
}

std::vector<shared::ShiftedPath> ShiftLab::shifted(const std::vector<shared::OfferedPath>& paths,
                                                   const std::vector<uint32_t>& destinations)
{
    const gpu::Buffer from = upload("Paths", paths), to = upload("Destinations", destinations);
    const gpu::Buffer found =
        device_.createBuffer({.label = "ShiftedPaths", .size = paths.size() * sizeof(shared::ShiftedPath)});
    run(kernels_ + "shift_test",
        {{"Surfaces", &surfaces_}, {"Paths", &from}, {"Destinations", &to}, {"ShiftedPaths", &found}},
        {uint32_t(paths.size())});
    return device_.queue().readAs<shared::ShiftedPath>(found);
}

void ShiftLab::run(const std::string& kernel, const passes::NamedBuffers& buffers, gpu::Threads threads)
{
    const passes::Stage stage({.device = device_,
                               .pipelines = pipelines_,
                               .scene = *scene_,
                               .variant = variant_,
                               .frame = {{"Frame", &frame_}, {"Counters", &counters_}}},
                              kernel, buffers);
    gpu::CommandEncoder encoder = device_.createCommandEncoder(kernel);
    stage.encode(encoder, threads);
    device_.queue().wait(device_.queue().submit(std::move(encoder)));
    const std::vector<uint32_t> counters = device_.queue().readAs<uint32_t>(counters_);
    for (uint32_t i = 0; i < shared::STAGE_COUNT; ++i)
        EXPECT_EQ(counters[size_t{2} * (shared::COUNTER_NONFINITE + i)], 0u) << kernel;
}

template <class T>
gpu::Buffer ShiftLab::upload(const char* label, const std::vector<T>& values)
{
    gpu::Buffer buffer = device_.createBuffer({.label = label, .size = values.size() * sizeof(T)});
    device_.queue().write(buffer, std::as_bytes(std::span(values)));
    return buffer;
}

} // namespace support
