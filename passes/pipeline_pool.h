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
    explicit PipelinePool(gpu::Device& device);

    // Compiles when it has not got it. Throws Error: the shader does not compile.
    std::shared_ptr<const gpu::ComputePipeline> get(const std::string& shader, const Variant& variant);
    void put(const std::string& shader, const Variant& variant, gpu::ComputePipeline&& pipeline);
    size_t size() const { return entries_.size(); }
    size_t capacity() const { return capacity_; } // beyond, the least recently used goes; those in use live on
    void clear() { entries_.clear(); }            // shaders have changed on disk; those in use live on

  private:
    struct Entry {
        std::string shader;
        Variant variant;
        std::shared_ptr<const gpu::ComputePipeline> pipeline;
    };
    gpu::Device& device_;
    const size_t capacity_;
    std::list<Entry> entries_; // the last used first
};

} // namespace passes
