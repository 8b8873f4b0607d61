#pragma once
// One stage of a frame: a shader, its pipeline, and what it is bound to. The shader is the declaration; a stage only
// says which buffer goes under which name.

#include <string>
#include <utility>
#include <vector>

#include "engine/gpu/gpu.h"
#include "engine/scene/gpu_scene.h"
#include "passes/pipeline_pool.h"
#include "passes/variant.h"

namespace passes
{

using NamedBuffers = std::vector<std::pair<std::string, const gpu::Buffer*>>;

// What all stages of a renderer share.
struct StageContext {
    gpu::Device& device;
    PipelinePool& pipelines;
    const scene::GpuScene& scene;
    const Variant& variant;
    NamedBuffers frame; // set 0
};

class Stage
{
  public:
    // `name` is the shader's, and the label of its timings; `buffers` hold set 2; those that the
    // shader does not name are left alone.
    Stage(const StageContext& context, const std::string& name, const NamedBuffers& buffers);

    void encode(gpu::CommandEncoder& encoder, gpu::Threads threads) const;

  private:
    std::shared_ptr<const gpu::ComputePipeline> pipeline_;
    gpu::BindGroup frameGroup_;
    bool usesScene_;
    gpu::BindGroup sceneGroup_, ownGroup_;
};

} // namespace passes
