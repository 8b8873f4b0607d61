#pragma once
// The scene's tables as buffers by name, for kernels of tests that read a scene; and a frame's, blank.

#include <string>
#include <utility>
#include <vector>

#include "engine/gpu/gpu.h"
#include "engine/scene/scene_tables.h"

namespace support
{

class SceneBuffers
{
  public:
    SceneBuffers(gpu::Device& device, const scene::Scene& scene);

    const scene::SceneTables& tables() const { return tables_; }

    // Those of sets 0 and 1, followed by `others`.
    std::vector<std::pair<std::string, const gpu::Buffer*>>
    with(const std::vector<std::pair<std::string, const gpu::Buffer*>>& others) const;

  private:
    scene::SceneTables tables_;
    std::vector<std::pair<std::string, gpu::Buffer>> buffers_;
};

} // namespace support
