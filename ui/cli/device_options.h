#pragma once
// --device and its kin: which Vulkan device, with which shaders, tuned how.

#include <string>

#include <CLI/CLI.hpp>

#include "engine/gpu/gpu.h"

namespace ui
{

// Where what can be made again is kept; empty, and so no cache, when there is no home.
std::string cacheDirectory();

class DeviceOptions
{
  public:
    void addTo(CLI::App& app);                                      // must live until the options are read
    gpu::Device open(bool robust = false) const;                    // throws Error
    const std::string& shaderDirectory() const { return shaders_; } // empty: the embedded ones
    const std::string& tuning() const { return tuning_; }           // overrides of what the device's class gets

  private:
    std::string device_, shaders_, tuning_;
    double stall_ = gpu::DeviceDescriptor().stallSeconds;
};

} // namespace ui
