#pragma once
// Reads what the reservoirs of the last frame hold. Costs nothing until it exists.

#include <array>
#include <vector>

#include "passes/renderer.h"
#include "shaders/shared/inspection.h"

namespace passes
{

// Of one pixel: how many spatial shifts of its samples to neighbors, of all its reservoirs, ended how
// (shared::SHIFT_*).
using ShiftCounts = std::array<uint32_t, shared::SHIFT_OUTCOMES>;

class Inspector
{
  public:
    // For the renderer's present settings: a new one is needed after apply(). Each function compiles its stage when it
    // is first called; those are "inspect", "inspect_shifts" and "inspect_path". All wait.
    explicit Inspector(Renderer& renderer);

    // Reservoir c of a pixel is element c * width * height + y * width + x; the path tracer has none. Throws Error: a
    // picture too large for the device.
    std::vector<shared::Inspection> reservoirs();
    // By pixel; empty without spatial reuse. Shifts once more: costs as much as the stage spatial_trace.
    std::vector<ShiftCounts> shifts();
    // Of a pixel: by reservoir, the points of the path that it holds, x_1 first, the light last; empty: it holds none.
    // For the path tracer the one walk of the last frame, whether it found light or not.
    std::vector<std::vector<shared::PathPoint>> paths(uint32_t pixel);

  private:
    struct Tool {
        std::unique_ptr<Stage> stage;
        gpu::Buffer result;
    };
    void prepare(Tool& tool, const char* stage, const char* result, uint64_t bytes,
                 gpu::Usage usage = gpu::Usage::Table);
    void run(const Tool& tool, gpu::Threads threads);

    Renderer& renderer_;
    gpu::Buffer request_;
    Tool reservoirs_, shifts_, paths_;
};

} // namespace passes
