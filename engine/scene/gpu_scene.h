#pragma once
// The scene on the device: the tables of SceneTables as buffers, bound as set 1 of every stage.

#include "engine/gpu/gpu.h"
#include "engine/scene/scene_tables.h"

namespace scene
{

class GpuScene
{
  public:
    // Uploads at once; the CPU copies of the tables can go afterwards.
    GpuScene(gpu::Device& device, const SceneTables& tables);

    gpu::BindGroup bind(gpu::Device& device, const gpu::ComputePipeline& pipeline) const;
    uint64_t bytes() const;                         // on the device
    uint64_t contents() const { return contents_; } // a fingerprint of all of it: equal scenes have equal ones

  private:
    gpu::Buffer nodes_, triangles_, attributes_, texels_, sceneData_, uniform_;
    uint64_t contents_ = 0;
};

} // namespace scene
