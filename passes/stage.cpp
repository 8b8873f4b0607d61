#include "passes/stage.h"

#include "shaders/shared/types.h"

namespace passes
{

namespace
{

NamedBuffers namedBy(const gpu::ComputePipeline& pipeline, const NamedBuffers& buffers)
{
    NamedBuffers named;
    for (const auto& [name, buffer] : buffers)
        for (const gpu::Binding& binding : pipeline.bindings())
            if (binding.set == SET_PASS && binding.name == name) named.emplace_back(name, buffer);
    return named;
}

} // namespace

Stage::Stage(const StageContext& context, const std::string& name, const NamedBuffers& buffers)
    : pipeline_(context.device.createComputePipeline({.label = name, .constants = constants(context.variant)})),
      frameGroup_(context.device.createBindGroup(
          {.label = "frame", .pipeline = &pipeline_, .set = SET_FRAME, .buffers = context.frame})),
      sceneGroup_(context.scene.bind(context.device, pipeline_)),
      ownGroup_(context.device.createBindGroup({.label = name, .pipeline = &pipeline_, .set = SET_PASS, .buffers = namedBy(pipeline_, buffers)}))
{
}

void Stage::encode(gpu::CommandEncoder& encoder, gpu::Threads threads) const
{
    encoder.dispatch({.pipeline = &pipeline_, .groups = {&frameGroup_, &sceneGroup_, &ownGroup_}, .threads = threads});
}

} // namespace passes
