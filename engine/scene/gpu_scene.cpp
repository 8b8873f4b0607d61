#include "engine/scene/gpu_scene.h"

#include "engine/base/fingerprint.h"

#include <algorithm>

namespace scene
{

namespace
{

gpu::Buffer uploadTable(gpu::Device& device, const char* label, std::span<const glm::uvec4> rows)
{
    const glm::uvec4 nothing(0);
    if (rows.empty()) rows = std::span(&nothing, 1);
    gpu::Buffer buffer = device.createBuffer({.label = label, .size = rows.size_bytes(), .usage = gpu::Usage::Table});
    device.queue().write(buffer, std::as_bytes(rows));
    return buffer;
}

} // namespace

TraversalStack traversalStack(const gpu::Adapter& adapter, const BvhStats& bvh)
{
    constexpr uint32_t STEP = 4;            // trees of about one depth share pipelines
    constexpr uint32_t MOST_REGISTERS = 16; // all of them move at each visit
    const uint32_t entries = std::max((bvh.depth + STEP - 1) / STEP * STEP, STEP);
    const bool wanted = adapter.tuning.stack == gpu::Tuning::Stack::Registers;
    return {.entries = entries, .inRegisters = wanted && entries <= MOST_REGISTERS};
}

GpuScene::GpuScene(gpu::Device& device, const SceneTables& tables)
    : nodes_(uploadTable(device, "Nodes", tables.bvh.nodes)),
      triangles_(uploadTable(device, "Triangles", tables.bvh.triangles)),
      attributes_(uploadTable(device, "Attributes", tables.attributes)),
      texels_(uploadTable(device, "Texels", tables.texels)),
      sceneData_(uploadTable(device, "SceneData", tables.sceneData)),
      uniform_(
          device.createBuffer({.label = "Scene", .size = sizeof(shared::SceneUniform), .usage = gpu::Usage::Uniform})),
      stack_(traversalStack(device.adapter(), tables.bvh.stats))
{
    device.queue().writeValue(uniform_, tables.uniform);
    for (const std::vector<glm::uvec4>* rows :
         {&tables.bvh.nodes, &tables.bvh.triangles, &tables.attributes, &tables.texels, &tables.sceneData})
        contents_ = fingerprint(std::as_bytes(std::span(*rows)), contents_);
    contents_ = fingerprint(std::as_bytes(std::span(&tables.uniform, 1)), contents_);
}

gpu::BindGroup GpuScene::bind(gpu::Device& device, const gpu::ComputePipeline& pipeline) const
{
    return device.createBindGroup({.label = "scene",
                                   .pipeline = &pipeline,
                                   .set = SET_SCENE,
                                   .buffers = {{"Nodes", &nodes_},
                                               {"Triangles", &triangles_},
                                               {"Attributes", &attributes_},
                                               {"Texels", &texels_},
                                               {"SceneData", &sceneData_},
                                               {"Scene", &uniform_}}});
}

uint64_t GpuScene::bytes() const
{
    return nodes_.size() + triangles_.size() + attributes_.size() + texels_.size() + sceneData_.size() +
           uniform_.size();
}

} // namespace scene
