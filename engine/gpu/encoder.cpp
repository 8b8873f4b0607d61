// Recording of work: dispatches, copies and the barriers between them.

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/gpu/vulkan.h"

#include <algorithm>

namespace gpu
{

namespace
{

constexpr VkPipelineStageFlags WORK_STAGES = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;

// One barrier for all memory: with a handful of buffers per dispatch, naming them gains nothing.
void barrier(VkCommandBuffer commands, VkPipelineStageFlags toStages, VkAccessFlags toAccess)
{
    const VkMemoryBarrier memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                    .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                                    .dstAccessMask = toAccess};
    vkCmdPipelineBarrier(commands, WORK_STAGES, toStages, 0, 1, &memory, 0, nullptr, 0, nullptr);
}

void barrierBeforeWork(VkCommandBuffer commands)
{
    barrier(commands, WORK_STAGES,
            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_UNIFORM_READ_BIT |
                VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
}

// How the dispatch touches each buffer. Checks that the groups fit the pipeline.
std::vector<BufferUse<VkBuffer>> usesOf(const PipelineState& pipeline, const Dispatch& dispatch)
{
    std::vector<BufferUse<VkBuffer>> uses;
    for (const Binding& binding : pipeline.bindings) {
        const BindGroup* group = binding.set < dispatch.groups.size() ? dispatch.groups[binding.set] : nullptr;
        if (!group || !group->state())
            checkFailed(__FILE__, __LINE__,
                        fmt::format("dispatch of \"{}\" lacks bind group {}", pipeline.label, binding.set));
        const BindGroupState& state = *group->state();
        if (state.layout != pipeline.setLayouts[binding.set])
            checkFailed(__FILE__, __LINE__,
                        fmt::format("bind group \"{}\" does not fit set {} of pipeline \"{}\"", state.label,
                                    binding.set, pipeline.label));
        uses.push_back({state.buffers.at(binding.binding), binding.reads, binding.writes});
    }
    return uses;
}

} // namespace

EncoderState::EncoderState(DeviceState& owner, const std::string& name)
    : device(&owner), label(name), commands(owner.takeCommandBuffer())
{
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                           .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    vkCheck(vkBeginCommandBuffer(commands, &info), "vkBeginCommandBuffer", label);
    owner.name(VK_OBJECT_TYPE_COMMAND_BUFFER, commands, label);
    barrierBeforeWork(commands); // orders it after all that was submitted earlier
    ++device->openEncoders;
}

EncoderState::~EncoderState()
{
    --device->openEncoders;
    if (commands) device->recycle({commands}, std::move(timestamps.pages));
}

void EncoderState::finish()
{
    barrier(commands, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    vkCheck(vkEndCommandBuffer(commands), "vkEndCommandBuffer", label);
}

void EncoderState::beforeWork(std::span<const BufferUse<VkBuffer>> uses)
{
    if (hazards.needsBarrier(uses)) barrierBeforeWork(commands);
}

void EncoderState::timestamp(uint32_t query)
{
    const uint32_t perPage = 2 * Timestamps::DISPATCHES_PER_PAGE;
    if (query / perPage == timestamps.pages.size()) {
        timestamps.pages.push_back(device->takeQueryPage());
        vkCmdResetQueryPool(commands, timestamps.pages.back(), 0, perPage);
    }
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timestamps.pages[query / perPage],
                        query % perPage);
}

void EncoderState::dispatch(const Dispatch& dispatch)
{
    CHECK(dispatch.pipeline && dispatch.pipeline->state());
    const PipelineState& pipeline = *dispatch.pipeline->state();
    const std::string& name = dispatch.label.empty() ? pipeline.label : dispatch.label;
    const std::array threads = {dispatch.threads.x, dispatch.threads.y, dispatch.threads.z};
    std::array<uint32_t, 3> groups;
    for (uint32_t axis = 0; axis < 3; ++axis) {
        const uint32_t size = pipeline.workgroupSize[axis];
        const uint32_t limit = device->properties.limits.maxComputeWorkGroupCount[axis];
        groups[axis] = uint32_t((uint64_t(threads[axis]) + size - 1) / size);
        if (groups[axis] > limit)
            throw Error("Dispatch \"{}\" needs {} workgroups along {}, more than the device's {}.", name, groups[axis],
                        "xyz"[axis], limit);
    }
    const auto uses = usesOf(pipeline, dispatch);
    if (groups[0] == 0 || groups[1] == 0 || groups[2] == 0) return;

    if (device->beginLabel) {
        const VkDebugUtilsLabelEXT region = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT,
                                             .pLabelName = name.c_str()};
        device->beginLabel(commands, &region);
    }
    beforeWork(uses);
    const bool timed = device->physical.adapter.limits.timestamps;
    const uint32_t index = uint32_t(timestamps.labels.size());
    if (timed) timestamp(2 * index);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
    for (uint32_t set = 0; set < pipeline.setLayouts.size(); ++set)
        if (set < dispatch.groups.size() && dispatch.groups[set])
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, set, 1,
                                    &dispatch.groups[set]->state()->descriptors, 0, nullptr);
    vkCmdDispatch(commands, groups[0], groups[1], groups[2]);
    if (timed) {
        timestamp(2 * index + 1);
        timestamps.labels.push_back(name);
    }
    if (device->endLabel) device->endLabel(commands);
}

void EncoderState::copy(const BufferState& from, const BufferState& to, const VkBufferCopy& region)
{
    const BufferUse<VkBuffer> uses[] = {{from.buffer, true, false}, {to.buffer, false, true}};
    beforeWork(uses);
    vkCmdCopyBuffer(commands, from.buffer, to.buffer, 1, &region);
}

void EncoderState::fill(const BufferState& buffer, uint32_t word)
{
    const BufferUse<VkBuffer> uses[] = {{buffer.buffer, false, true}};
    beforeWork(uses);
    vkCmdFillBuffer(commands, buffer.buffer, 0, VK_WHOLE_SIZE, word);
}

CommandEncoder Device::createCommandEncoder(const std::string& label)
{
    return CommandEncoder(std::make_unique<EncoderState>(*state_, label));
}

CommandEncoder::CommandEncoder(std::unique_ptr<EncoderState> state) : state_(std::move(state)) {}
CommandEncoder::CommandEncoder(CommandEncoder&&) noexcept = default;
CommandEncoder& CommandEncoder::operator=(CommandEncoder&&) noexcept = default;
CommandEncoder::~CommandEncoder() = default;
std::unique_ptr<EncoderState> CommandEncoder::release()
{
    return std::move(state_);
}

void CommandEncoder::dispatch(const Dispatch& dispatch)
{
    state_->dispatch(dispatch);
}

void CommandEncoder::copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t fromOffset, uint64_t toOffset)
{
    CHECK(from.state() && to.state() && from.state() != to.state());
    CHECK_LE(fromOffset, from.size());
    if (bytes == 0) bytes = from.size() - fromOffset;
    CHECK_LE(bytes, from.size() - fromOffset);
    CHECK_LE(toOffset, to.size());
    CHECK_LE(bytes, to.size() - toOffset);
    if (bytes > 0) state_->copy(*from.state(), *to.state(), {fromOffset, toOffset, bytes});
}

void CommandEncoder::clear(const Buffer& buffer, uint32_t word)
{
    CHECK(buffer.state());
    state_->fill(*buffer.state(), word);
}

} // namespace gpu
