#include "engine/scene/gpu_scene.h"

#include "engine/base/check.h"
#include "engine/base/fingerprint.h"

#include <algorithm>

namespace scene
{

namespace
{

gpu::Buffer createTable(gpu::Device& device, const char* label, uint64_t rows)
{
    return device.createBuffer(
        {.label = label, .size = std::max<uint64_t>(rows, 1) * sizeof(glm::uvec4), .usage = gpu::Usage::Table});
}

void writeRows(gpu::Device& device, const gpu::Buffer& table, std::span<const glm::uvec4> rows, uint64_t first)
{
    device.queue().write(table, std::as_bytes(rows), first * sizeof(glm::uvec4));
}

std::shared_ptr<const gpu::Buffer> uploadTexels(gpu::Device& device, std::span<const glm::uvec4> rows)
{
    auto table = std::make_shared<gpu::Buffer>(createTable(device, "Texels", rows.size()));
    writeRows(device, *table, rows, 0);
    return table;
}

std::span<const glm::uvec4> rowsOf(const std::vector<glm::uvec4>& table, const RowRange& range)
{
    return std::span(table).subspan(range.first, range.end - range.first);
}

} // namespace

TraversalStack traversalStack(const gpu::Adapter& adapter, const BvhStats& bvh)
{
    constexpr uint32_t STEP = 4;            // trees of about one depth share pipelines
    constexpr uint32_t MOST_REGISTERS = 16; // all of them move at each visit
    const uint32_t entries = std::max((bvh.depth + STEP - 1) / STEP * STEP, STEP);
    const bool wanted = adapter.tuning.stack == gpu::Tuning::Stack::Registers;
    return {.entries = entries, .inRegisters = wanted && entries <= MOST_REGISTERS};
}

GpuScene::GpuScene(gpu::Device& device, const SceneTables& tables, const TableSizes& room, uint32_t worlds,
                   std::shared_ptr<const gpu::Buffer> texels)
    : room_(room), first_({.node = worlds * (room.nodes + room.placeNodes),
                           .record = worlds * (room.triangles + room.placeRecords),
                           .attribute = worlds * room.attributes}),
      texels_(texels ? std::move(texels) : uploadTexels(device, tables.texels)),
      nodes_(createTable(device, "Nodes", uint64_t{first_.node} + room.meshNodes)),
      triangles_(createTable(device, "Triangles", uint64_t{first_.record} + room.meshRecords)),
      attributes_(createTable(device, "Attributes", uint64_t{first_.attribute} + room.meshAttributes)),
      sceneData_(createTable(device, "SceneData", tables.environment.size() + uint64_t{worlds} * room.sceneData)),
      uniform_(device.createBuffer({.label = "Scene", .size = sizeof(worlds_), .usage = gpu::Usage::Uniform})),
      stack_(traversalStack(device.adapter(), {.depth = room.depth}))
{
    writeRows(device, sceneData_, tables.environment, 0);
    const MeshTables& meshes = tables.meshes;
    writeRows(
        device, nodes_,
        movedNodes(meshes.nodes, first_.node / shared::BVH_NODE_STRIDE, first_.record / shared::BVH_RECORD_STRIDE),
        first_.node);
    writeRows(device, triangles_, meshes.triangles, first_.record);
    writeRows(device, attributes_, meshes.attributes, first_.attribute);
    for (const std::vector<glm::uvec4>* rows :
         {&tables.bvh.nodes, &tables.bvh.triangles, &tables.attributes, &tables.texels, &tables.environment,
          &tables.sceneData, &meshes.nodes, &meshes.triangles, &meshes.attributes, &tables.places.records})
        contents_ = fingerprint(std::as_bytes(std::span(*rows)), contents_);
    contents_ = fingerprint(std::as_bytes(std::span(&tables.uniform, 1)), contents_);
}

GpuScene::GpuScene(gpu::Device& device, const SceneTables& tables)
    : GpuScene(device, tables, sizesOf(tables), 1, nullptr)
{
    write(device, 0, tables, {});
}

GpuScene::GpuScene(gpu::Device& device, const MovingTables& tables, const GpuScene* other)
    : GpuScene(device, tables.last(), tables.most(), 2, other ? other->texels_ : nullptr)
{
    if (!other) return;
    contents_ = other->contents_; // textures are forgotten by now
    worlds_ = other->worlds_;
    versions_ = other->versions_;
    gpu::CommandEncoder encoder = device.createCommandEncoder("poses");
    encoder.copy(other->nodes_, nodes_);
    encoder.copy(other->triangles_, triangles_);
    encoder.copy(other->attributes_, attributes_);
    encoder.copy(other->sceneData_, sceneData_);
    encoder.copy(other->uniform_, uniform_);
    device.queue().wait(device.queue().submit(std::move(encoder)));
}

void GpuScene::write(gpu::Device& device, uint32_t world, const SceneTables& pose, const TableChanges& changes)
{
    const uint32_t node = world * (room_.nodes + room_.placeNodes);
    const uint32_t record = world * (room_.triangles + room_.placeRecords);
    const uint32_t data = world * room_.sceneData;
    CHECK(pose.bvh.nodes.size() <= room_.nodes && pose.bvh.triangles.size() <= room_.triangles);
    CHECK(pose.attributes.size() <= room_.attributes && pose.sceneData.size() <= room_.sceneData);
    CHECK(pose.places.nodes.size() <= room_.placeNodes && pose.places.records.size() <= room_.placeRecords);
    CHECK_LE(pose.bvh.stats.depth, room_.depth);
    shared::SceneUniform& uniform = worlds_[world];
    uniform = pose.uniform;
    uniform.rootNode = node / shared::BVH_NODE_STRIDE;
    uniform.attributeOffset = world * room_.attributes;
    for (uint32_t* offset :
         {&uniform.materialOffset, &uniform.lightOffset, &uniform.punctualOffset, &uniform.instanceOffset})
        *offset += data;
    uniform.instanceRoot = (node + room_.nodes) / shared::BVH_NODE_STRIDE;

    const bool all = versions_[world] != changes.tree.version; // or else what is there differs in some rows only
    versions_[world] = changes.tree.version;
    const auto eachRange = [&](const std::vector<RowRange>& ranges, const std::vector<glm::uvec4>& table,
                               auto&& visit) {
        if (all)
            visit(RowRange{0, uint32_t(table.size())});
        else
            std::ranges::for_each(ranges, visit);
    };
    eachRange(changes.tree.nodes, pose.bvh.nodes, [&](const RowRange& range) {
        writeRows(device, nodes_,
                  movedNodes(rowsOf(pose.bvh.nodes, range), uniform.rootNode, record / shared::BVH_RECORD_STRIDE),
                  node + range.first);
    });
    eachRange(changes.tree.triangles, pose.bvh.triangles, [&](const RowRange& range) {
        writeRows(device, triangles_, rowsOf(pose.bvh.triangles, range), record + range.first);
    });
    eachRange(changes.attributes, pose.attributes, [&](const RowRange& range) {
        writeRows(device, attributes_, rowsOf(pose.attributes, range), uniform.attributeOffset + range.first);
    });
    writeRows(device, sceneData_, pose.sceneData, pose.environment.size() + data);
    if (!pose.places.nodes.empty()) writePlaces(device, pose.places, uniform, record + room_.triangles);
    device.queue().write(uniform_, std::as_bytes(std::span(worlds_)));
}

// Behind what lies in the world, with the rows of their meshes.
void GpuScene::writePlaces(gpu::Device& device, PlaceTables places, const shared::SceneUniform& uniform,
                           uint32_t firstRecord)
{
    writeRows(device, nodes_, movedNodes(places.nodes, uniform.instanceRoot, firstRecord / shared::BVH_RECORD_STRIDE),
              uint64_t{uniform.instanceRoot} * shared::BVH_NODE_STRIDE);
    for (size_t i = 3; i < places.records.size(); i += shared::BVH_RECORD_STRIDE)
        places.records[i].x += first_.node / shared::BVH_NODE_STRIDE;
    writeRows(device, triangles_, places.records, firstRecord);
    for (size_t i = 3; i < places.rows.size(); i += shared::INSTANCE_ROWS) places.rows[i].x += first_.attribute;
    writeRows(device, sceneData_, places.rows, uniform.instanceOffset);
}

gpu::BindGroup GpuScene::bind(gpu::Device& device, const gpu::ComputePipeline& pipeline) const
{
    return device.createBindGroup({.label = "scene",
                                   .pipeline = &pipeline,
                                   .set = SET_SCENE,
                                   .buffers = {{"Nodes", &nodes_},
                                               {"Triangles", &triangles_},
                                               {"Attributes", &attributes_},
                                               {"Texels", texels_.get()},
                                               {"SceneData", &sceneData_},
                                               {"Scene", &uniform_}}});
}

uint64_t GpuScene::bytes() const
{
    return nodes_.size() + triangles_.size() + attributes_.size() + texels_->size() + sceneData_.size() +
           uniform_.size();
}

} // namespace scene
