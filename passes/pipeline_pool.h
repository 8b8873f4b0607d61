#pragma once
// Compiled shaders by name and constants, so that nothing is compiled twice while settings go back and forth.

#include <list>
#include <memory>
#include <string>
#include <utility>

#include "engine/gpu/gpu.h"
#include "passes/variant.h"

namespace passes
{

class PipelinePool
{
  public:
    static constexpr size_t CAPACITY = 64; // pipelines that nobody uses; the least recently used goes first

    explicit PipelinePool(gpu::Device& device) : device_(device) {}

    // Compiles when it has not got it. Throws Error: the shader does not compile.
    std::shared_ptr<const gpu::ComputePipeline> get(const std::string& shader, const Variant& variant);
    void put(const std::string& shader, const Variant& variant, gpu::ComputePipeline&& pipeline);
    void clear() { entries_.clear(); } // shaders have changed on disk; those in use live on

  private:
    struct Entry {
        std::string shader;
        Variant variant;
        std::shared_ptr<const gpu::ComputePipeline> pipeline;
    };
    gpu::Device& device_;
    std::list<Entry> entries_; // the last used first
};

} // namespace passes
