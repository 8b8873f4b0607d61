#pragma once
// The buffers of a frame that grow with the picture: a row of one list each.

#include <string_view>
#include <vector>

#include "engine/gpu/gpu.h"
#include "passes/settings.h"
#include "passes/stage.h"

namespace passes
{

struct PixelBuffer {
    const char* name;             // as the shaders declare it
    uint64_t bytes;               // of a pixel; 0: these settings do not use it
    bool lasts = false;           // the next frame needs it; all others are written before they are read in each frame
    const char* blame = "--size"; // the settings to change when it is too large for the device
    gpu::Usage usage = gpu::Usage::Table;
};
std::vector<PixelBuffer> pixelBuffers(const Settings& settings);

// Bytes of a pixel in all of them, and of a reservoir in both sets.
uint64_t bytesPerPixel(const Settings& settings);
double bytesPerReservoir(const Settings& settings);

// How many pictures of these settings, one below the other, a device takes at once.
uint32_t maxRuns(const gpu::Limits& limits, const Settings& settings);

// Whether storage bindings hold all buffers of so many pictures.
bool fitStorageBindings(const gpu::Limits& limits, const Settings& settings, uint32_t runs);

class FrameBuffers
{
  public:
    FrameBuffers() = default;
    // Throws Error: too large for the device.
    FrameBuffers(gpu::Device& device, const Settings& settings, uint32_t runs);

    const gpu::Buffer& operator[](std::string_view name) const;
    NamedBuffers named() const;
    std::vector<const gpu::Buffer*> lasting() const;

  private:
    std::vector<PixelBuffer> rows_;
    std::vector<gpu::Buffer> buffers_; // by row
};

} // namespace passes
