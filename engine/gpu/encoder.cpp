// Recording of work: dispatches, copies and the barriers between them.

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/gpu/vulkan.h"

#include <algorithm>
#include <cmath>

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
        const VkBuffer buffer = state.buffers.at(binding.binding);
        for (const BufferUse<VkBuffer>& other : uses)
            if (other.buffer == buffer && (other.writes || binding.writes))
                checkFailed(__FILE__, __LINE__,
                            fmt::format("dispatch of \"{}\" writes \"{}\" and binds the same buffer under another name",
                                        pipeline.label, binding.name));
        uses.push_back({buffer, binding.reads, binding.writes});
    }
    return uses;
}

} // namespace

EncoderState::EncoderState(DeviceState& owner, const std::string& name) : device(&owner), label(name)
{
    begin();
    ++device->openEncoders;
}

EncoderState::~EncoderState()
{
    --device->openEncoders;
    for (const VkCommandBuffer buffer : commands) vkResetCommandBuffer(buffer, 0);
    device->recycle(std::move(commands), std::move(timestamps.pages));
}

void EncoderState::begin()
{
    commands.push_back(device->takeCommandBuffer());
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                           .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    vkCheck(vkBeginCommandBuffer(current(), &info), "vkBeginCommandBuffer", label);
    device->name(VK_OBJECT_TYPE_COMMAND_BUFFER, current(), label);
    barrierBeforeWork(current()); // orders it after all that was submitted earlier
    milliseconds_ = 0;
    names.push_back(label);
}

void EncoderState::finish()
{
    barrier(current(), VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    vkCheck(vkEndCommandBuffer(current()), "vkEndCommandBuffer", label);
}

void EncoderState::beforeWork(std::span<const BufferUse<VkBuffer>> uses)
{
    if (hazards.needsBarrier(uses)) barrierBeforeWork(current());
}

void EncoderState::timestamp(uint32_t query)
{
    const uint32_t perPage = 2 * Timestamps::DISPATCHES_PER_PAGE;
    if (query / perPage == timestamps.pages.size()) {
        timestamps.pages.push_back(device->takeQueryPage());
        vkCmdResetQueryPool(current(), timestamps.pages.back(), 0, perPage);
    }
    vkCmdWriteTimestamp(current(), VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timestamps.pages[query / perPage],
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
            throw Error("Dispatch \"{}\" needs {} workgroups along {}, more than the {} of \"{}\"{}.", name,
                        groups[axis], "xyz"[axis], limit, device -> physical.adapter.name,
                        dispatch.setting.empty() ? "" : "; reduce " + dispatch.setting);
    }
    const auto uses = usesOf(pipeline, dispatch);
    if (groups[0] == 0 || groups[1] == 0 || groups[2] == 0) return;

    beforeWork(uses);
    const bool timed = device->physical.adapter.limits.timestamps;
    const uint32_t index = uint32_t(timestamps.dispatches.size());
    if (timed) timestamp(2 * index);
    dispatchInBands(pipeline, dispatch, groups, name);
    if (timed) {
        timestamp(2 * index + 1);
        timestamps.dispatches.push_back(
            {name, uint64_t{groups[0]} * groups[1] * groups[2], pipeline.groupMilliseconds});
    }
}

// Bands along the longest axis, each short enough to be expected below LONGEST_MILLISECONDS.
void EncoderState::dispatchInBands(const PipelineState& pipeline, const Dispatch& dispatch,
                                   const std::array<uint32_t, 3>& groups, const std::string& name)
{
    const uint32_t axis = uint32_t(std::ranges::max_element(groups) - groups.begin());
    const std::optional<double> known = *pipeline.groupMilliseconds; // not by name: variants may differ tenfold
    const bool isKnown = known.has_value();
    const double slice = known.value_or(0) * groups[0] * groups[1] * groups[2] / groups[axis];
    const double bands = isKnown ? std::ceil(slice * groups[axis] / LONGEST_MILLISECONDS) : FIRST_BANDS;
    const uint32_t step = uint32_t(std::clamp(std::floor(groups[axis] / bands), 1.0, double(groups[axis])));

    for (std::array<uint32_t, 3> base = {0, 0, 0}; base[axis] < groups[axis]; base[axis] += step) {
        std::array<uint32_t, 3> size = groups;
        size[axis] = std::min(step, groups[axis] - base[axis]);
        const double expected = isKnown ? slice * size[axis] : LONGEST_MILLISECONDS;
        if (milliseconds_ > 0 && milliseconds_ + expected > LONGEST_MILLISECONDS) {
            vkCheck(vkEndCommandBuffer(current()), "vkEndCommandBuffer", label);
            begin();
        }
        std::string& work = names.back(); // a fresh command buffer has the encoder's name
        if (milliseconds_ == 0)
            work = name;
        else if (!work.ends_with(name))
            work.append(", ").append(name);
        milliseconds_ += expected;

        if (device->beginLabel) {
            const VkDebugUtilsLabelEXT region = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT,
                                                 .pLabelName = name.c_str()};
            device->beginLabel(current(), &region);
        }
        vkCmdBindPipeline(current(), VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
        for (uint32_t set = 0; set < pipeline.setLayouts.size(); ++set)
            if (set < dispatch.groups.size() && dispatch.groups[set])
                vkCmdBindDescriptorSets(current(), VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, set, 1,
                                        &dispatch.groups[set]->state()->descriptors, 0, nullptr);
        vkCmdDispatchBase(current(), base[0], base[1], base[2], size[0], size[1], size[2]);
        if (device->endLabel) device->endLabel(current());
    }
}

void EncoderState::copy(const BufferState& from, const BufferState& to, const VkBufferCopy& region)
{
    const BufferUse<VkBuffer> uses[] = {{from.buffer, true, false}, {to.buffer, false, true}};
    beforeWork(uses);
    vkCmdCopyBuffer(current(), from.buffer, to.buffer, 1, &region);
}

void EncoderState::fill(const BufferState& buffer, uint32_t word)
{
    const BufferUse<VkBuffer> uses[] = {{buffer.buffer, false, true}};
    beforeWork(uses);
    vkCmdFillBuffer(current(), buffer.buffer, 0, VK_WHOLE_SIZE, word);
}

CommandEncoder Device::createCommandEncoder(const std::string& label)
{
    return CommandEncoder(std::make_unique<EncoderState>(*state_, label));
}

void CommandEncoder::dispatch(const Dispatch& dispatch)
{
    state()->dispatch(dispatch);
}

void CommandEncoder::copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t fromOffset, uint64_t toOffset)
{
    CHECK(from.state() && to.state() && from.state() != to.state());
    CHECK_LE(fromOffset, from.size());
    if (bytes == 0) bytes = from.size() - fromOffset;
    CHECK_LE(bytes, from.size() - fromOffset);
    CHECK_LE(toOffset, to.size());
    CHECK_LE(bytes, to.size() - toOffset);
    if (bytes > 0) state()->copy(*from.state(), *to.state(), {fromOffset, toOffset, bytes});
}

void CommandEncoder::clear(const Buffer& buffer, uint32_t word)
{
    CHECK(buffer.state());
    state()->fill(*buffer.state(), word);
}

} // namespace gpu
