#pragma once
// The scene on the device: the tables of SceneTables as buffers, bound as set 1 of every stage.

#include "engine/gpu/gpu.h"
#include "engine/scene/scene_tables.h"
#include "shaders/shared/bvh.h"

namespace scene
{

// Where traversal keeps what is left of nodes (shaders/scene/intersect.glsl): a matter of the tree and the device
// class.
struct TraversalStack {
    uint32_t entries = shared::BVH_STACK_SIZE;
    bool inRegisters = false; // else in an indexed array
};

TraversalStack traversalStack(const gpu::Adapter& adapter, const BvhStats& bvh);

class GpuScene
{
  public:
    // Uploads at once; the CPU copies of the tables can go afterwards.
    GpuScene(gpu::Device& device, const SceneTables& tables);

    gpu::BindGroup bind(gpu::Device& device, const gpu::ComputePipeline& pipeline) const;
    const TraversalStack& stack() const { return stack_; }
    uint64_t bytes() const;                         // on the device
    uint64_t contents() const { return contents_; } // a fingerprint of all of it: equal scenes have equal ones

  private:
    gpu::Buffer nodes_, triangles_, attributes_, texels_, sceneData_, uniform_;
    TraversalStack stack_;
    uint64_t contents_ = 0;
};

} // namespace scene
