#include "passes/stage.h"

#include "shaders/shared/types.h"

#include <algorithm>

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

bool uses(const gpu::ComputePipeline& pipeline, uint32_t set)
{
    return std::ranges::any_of(pipeline.bindings(), [&](const gpu::Binding& binding) { return binding.set == set; });
}

} // namespace

Stage::Stage(const StageContext& context, const std::string& name, const NamedBuffers& buffers)
    : pipeline_(context.pipelines.get(name, context.variant)),
      frameGroup_(context.device.createBindGroup(
          {.label = "frame", .pipeline = pipeline_.get(), .set = SET_FRAME, .buffers = context.frame})),
      usesScene_(uses(*pipeline_, SET_SCENE)),
      sceneGroup_(usesScene_ ? context.scene.bind(context.device, *pipeline_) : gpu::BindGroup()),
      ownGroup_(context.device.createBindGroup(
          {.label = name, .pipeline = pipeline_.get(), .set = SET_PASS, .buffers = namedBy(*pipeline_, buffers)}))
{
}

void Stage::encode(gpu::CommandEncoder& encoder, gpu::Threads threads) const
{
    encoder.dispatch({.pipeline = pipeline_.get(),
                      .groups = {&frameGroup_, usesScene_ ? &sceneGroup_ : nullptr, &ownGroup_},
                      .threads = threads});
}

} // namespace passes
