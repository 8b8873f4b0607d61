#pragma once
// The product's candidates and shifts, run on a small scene in which all kinds of vertices and lights occur: paths are
// drawn in the domain of one pixel, and shifted into that of another.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/gpu/gpu.h"
#include "engine/scene/gpu_scene.h"
#include "passes/pipeline_pool.h"
#include "passes/settings.h"
#include "passes/stage.h"
#include "shaders/shared/frame.h"
#include "tests/shaders/path/shifts.h"

namespace support
{

class ShiftLab
{
  public:
    static constexpr uint32_t SIZE = 32; // pixels of the picture, in both directions

    // `kernels` is put before the names of tests/shaders/path's kernels.
    ShiftLab(gpu::Device& device, const std::string& kernels, passes::Shift shift);

    bool sees(uint32_t pixel) const { return seen_[pixel]; }

    // By tree and path id (SHIFT_PATHS a tree): what each tree offers. A value that is not finite fails the test.
    std::vector<shared::OfferedPath> offered(const std::vector<shared::Tree>& trees);

    // Each path in the domain of its destination, a pixel.
    std::vector<shared::ShiftedPath> shifted(const std::vector<shared::OfferedPath>& paths,
                                             const std::vector<uint32_t>& destinations);

  private:
    void run(const std::string& kernel, const passes::NamedBuffers& buffers, gpu::Threads threads);
    template <class T>
    gpu::Buffer upload(const char* label, const std::vector<T>& values);

    gpu::Device& device_;
    std::string kernels_;
    passes::Variant variant_;
    passes::PipelinePool pipelines_;
    std::unique_ptr<scene::GpuScene> scene_;
    gpu::Buffer frame_, counters_, surfaces_;
    std::vector<bool> seen_;
};

} // namespace support
