#include "passes/inspector.h"

#include "engine/base/error.h"

namespace passes
{

Inspector::Inspector(Renderer& renderer) : renderer_(renderer)
{
    const Settings& settings = renderer.settings();
    if (settings.method == Method::Pt) throw Error("The path tracer has no reservoirs to look into.");
    inspections_ =
        renderer.device().createBuffer({.label = "Inspections",
                                        .size = uint64_t{settings.width} * settings.height *
                                                renderer.variant().RESERVOIR_COUNT * sizeof(shared::Inspection),
                                        .setting = "--size"});
    stage_ = renderer.makeStage("inspect", renderer.variant(), {{"Inspections", &inspections_}});
}

std::vector<shared::Inspection> Inspector::read()
{
    renderer_.wait();
    gpu::Device& device = renderer_.device();
    gpu::CommandEncoder encoder = device.createCommandEncoder("inspect");
    stage_->encode(encoder, {renderer_.settings().width, renderer_.settings().height});
    device.queue().wait(device.queue().submit(std::move(encoder)));
    device.queue().takeTimings(); // no frame's
    return device.queue().readAs<shared::Inspection>(inspections_);
}

} // namespace passes
