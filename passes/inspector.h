#pragma once
// Reads what the reservoirs of the last frame hold. Costs nothing until it exists.

#include <vector>

#include "passes/renderer.h"
#include "shaders/shared/inspection.h"

namespace passes
{

class Inspector
{
  public:
    // For the renderer's present settings: a new one is needed after apply(). Throws Error: a method without
    // reservoirs, a picture too large for the device.
    explicit Inspector(Renderer& renderer);

    // Waits. Reservoir c of a pixel is element c * width * height + y * width + x.
    std::vector<shared::Inspection> read();

  private:
    Renderer& renderer_;
    gpu::Buffer inspections_;
    std::unique_ptr<Stage> stage_;
};

} // namespace passes
