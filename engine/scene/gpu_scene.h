#pragma once
// The scene on the device: the tables of SceneTables as buffers, bound as set 1 of every stage. A scene that moves is
// there as two worlds, one after the other in each table (shaders/shared/scene.h); what worlds share comes
// last.

#include <array>
#include <memory>
#include <optional>

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
    // Of a scene that moves: what all poses share; write() fills both worlds. With `other`, of the same scene: its
    // textures, and the poses that it has.
    GpuScene(gpu::Device& device, const MovingTables& tables, const GpuScene* other = nullptr);

    // From the next submission on; `world`: 0 or 1.
    void write(gpu::Device& device, uint32_t world, const SceneTables& pose, const TableChanges& changes);

    gpu::BindGroup bind(gpu::Device& device, const gpu::ComputePipeline& pipeline) const;
    const TraversalStack& stack() const { return stack_; }
    uint64_t bytes() const;                         // on the device
    uint64_t contents() const { return contents_; } // a fingerprint of all of it: equal scenes have equal ones

  private:
    GpuScene(gpu::Device& device, const SceneTables& tables, const TableSizes& room, uint32_t worlds,
             std::shared_ptr<const gpu::Buffer> texels);
    void writePlaces(gpu::Device& device, PlaceTables places, const shared::SceneUniform& uniform,
                     uint32_t firstRecord);

    TableSizes room_; // of a world
    struct {
        uint32_t node = 0, record = 0, attribute = 0;
    } first_; // rows of the meshes that are stored once, behind those of all worlds
    std::array<shared::SceneUniform, 2> worlds_ = {};
    std::array<std::optional<uint64_t>, 2> versions_; // of the trees that are there
    std::shared_ptr<const gpu::Buffer> texels_;
    gpu::Buffer nodes_, triangles_, attributes_, sceneData_, uniform_;
    TraversalStack stack_;
    uint64_t contents_ = 0;
};

} // namespace scene
