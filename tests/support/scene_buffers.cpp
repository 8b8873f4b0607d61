#include "tests/support/scene_buffers.h"

#include "shaders/shared/frame.h"

namespace support
{

SceneBuffers::SceneBuffers(gpu::Device& device, const scene::Scene& scene)
    // Kernels run with the default constants: everything compiled in.
    : tables_(scene::makeSceneTables(scene, device.limits().tableBytes, {}, scene::FeatureSet::Everything))
{
    const auto add = [&](const char* name, std::span<const std::byte> bytes, gpu::Usage usage) {
        gpu::Buffer buffer = device.createBuffer({.label = name, .size = bytes.size(), .usage = usage});
        device.queue().write(buffer, bytes);
        buffers_.emplace_back(name, std::move(buffer));
    };
    const auto addTable = [&](const char* name, const auto& rows) {
        add(name, std::as_bytes(std::span(rows)), gpu::Usage::Table);
    };
    addTable("Nodes", tables_.bvh.nodes);
    addTable("Triangles", tables_.bvh.triangles);
    addTable("Attributes", tables_.attributes);
    addTable("Texels", tables_.texels);
    std::vector<glm::uvec4> sceneData = tables_.environment;
    sceneData.insert(sceneData.end(), tables_.sceneData.begin(), tables_.sceneData.end());
    addTable("SceneData", sceneData);
    const shared::SceneUniform worlds[2] = {tables_.uniform};
    add("Scene", std::as_bytes(std::span(worlds)), gpu::Usage::Uniform);
    const shared::FrameUniform frame = {};
    add("Frame", std::as_bytes(std::span(&frame, 1)), gpu::Usage::Uniform);
    const std::vector<uint32_t> counters(size_t{2} * shared::COUNTER_COUNT);
    add("Counters", std::as_bytes(std::span(counters)), gpu::Usage::Storage);
}

std::vector<std::pair<std::string, const gpu::Buffer*>>
SceneBuffers::with(const std::vector<std::pair<std::string, const gpu::Buffer*>>& others) const
{
    std::vector<std::pair<std::string, const gpu::Buffer*>> all;
    for (const auto& [name, buffer] : buffers_) all.emplace_back(name, &buffer);
    all.insert(all.end(), others.begin(), others.end());
    return all;
}

} // namespace support
