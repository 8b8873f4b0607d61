#include "passes/pipeline_pool.h"

#include <algorithm>

namespace passes
{

namespace
{

constexpr size_t CAPACITY = 64;
constexpr size_t CAPACITY_ON_CPU = 24; // there each holds megabytes of machine code; the driver has a cache of its own

} // namespace

PipelinePool::PipelinePool(gpu::Device& device)
    : device_(device), capacity_(device.adapter().kind == "cpu" ? CAPACITY_ON_CPU : CAPACITY)
{
}

std::shared_ptr<const gpu::ComputePipeline> PipelinePool::get(const std::string& shader, const Variant& variant)
{
    const auto found = std::ranges::find_if(
        entries_, [&](const Entry& entry) { return entry.shader == shader && entry.variant == variant; });
    if (found != entries_.end())
        entries_.splice(entries_.begin(), entries_, found);
    else
        put(shader, variant, device_.createComputePipeline({.label = shader, .constants = constants(variant)}));
    return entries_.front().pipeline;
}

void PipelinePool::put(const std::string& shader, const Variant& variant, gpu::ComputePipeline&& pipeline)
{
    entries_.push_front({shader, variant, std::make_shared<const gpu::ComputePipeline>(std::move(pipeline))});
    if (entries_.size() > capacity_) entries_.pop_back();
}

} // namespace passes
