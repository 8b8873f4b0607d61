// Compute pipelines and bind groups: Vulkan objects from what the shader declares.

#include "engine/base/check.h"
#include "engine/base/clock.h"
#include "engine/base/error.h"
#include "engine/gpu/shader.h"
#include "engine/gpu/vulkan.h"
#include "shaders/shared/tuning.h"

#include <algorithm>
#include <set>

#include <fmt/ranges.h>

namespace gpu
{

namespace
{

void checkLimits(const DeviceState& device, const Reflection& shader, const std::string& label)
{
    const Limits& limits = device.physical.adapter.limits;
    const std::string& deviceName = device.physical.adapter.name;

    // Tables do not count as storage buffers: in WebGPU, which has no texel buffers, they would be textures. Where they
    // are storage buffers, what this very device allows must hold all.
    const auto storage = uint64_t(std::ranges::count(shader.bindings, Binding::Kind::Storage, &Binding::kind));
    if (storage > limits.storageBuffersPerStage)
        throw Error("Shader \"{}\" declares {} storage buffers, more than the limit of {}.", label, storage,
                    limits.storageBuffersPerStage);
    uint64_t all = 0;
    for (const Binding& binding : shader.bindings)
        for (const auto& [number, type] : device.descriptorsOf(binding))
            all += type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const uint32_t most = device.properties.limits.maxPerStageDescriptorStorageBuffers;
    if (all > most)
        throw Error("Shader \"{}\" declares {} storage buffers and tables, more than the {} of \"{}\".", label, all,
                    most, deviceName);

    uint64_t invocations = 1;
    for (uint32_t axis = 0; axis < 3; ++axis) {
        const uint32_t size = shader.workgroupSize[axis];
        const std::string& constant = shader.workgroupSizeConstants[axis];
        const std::string advice = constant.empty() ? "" : fmt::format("; reduce the constant {}", constant);
        const uint32_t limit =
            std::min(device.properties.limits.maxComputeWorkGroupSize[axis], limits.workgroupInvocations);
        invocations *= size;
        if (size == 0 || size > limit || invocations > limits.workgroupInvocations)
            throw Error("Shader \"{}\" has workgroups of {} x {} x {}, more than the {} invocations ({} along {}) of "
                        "\"{}\"{}.",
                        label, shader.workgroupSize[0], shader.workgroupSize[1], shader.workgroupSize[2],
                        limits.workgroupInvocations, limit, "xyz"[axis], deviceName, advice);
    }
    if (shader.sharedBytes > limits.workgroupBytes)
        throw Error("Shader \"{}\" needs {} bytes of shared memory, more than the {} of \"{}\".", label,
                    shader.sharedBytes, limits.workgroupBytes, deviceName);
}

VkShaderModule createModule(const DeviceState& device, std::span<const uint32_t> spirv, const std::string& label)
{
    const VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = spirv.size_bytes(), .pCode = spirv.data()};
    VkShaderModule module = VK_NULL_HANDLE;
    vkCheck(vkCreateShaderModule(device.device, &info, nullptr, &module), "vkCreateShaderModule", label);
    device.name(VK_OBJECT_TYPE_SHADER_MODULE, module, label);
    return module;
}

void createLayout(PipelineState& pipeline)
{
    DeviceState& device = *pipeline.device;
    std::vector<std::map<uint32_t, VkDescriptorType>> sets;
    for (const Binding& binding : pipeline.bindings) {
        sets.resize(std::max<size_t>(sets.size(), binding.set + 1));
        sets[binding.set].merge(device.descriptorsOf(binding));
    }
    for (const auto& set : sets) pipeline.setLayouts.push_back(device.setLayout(set));
    const VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                             .setLayoutCount = uint32_t(pipeline.setLayouts.size()),
                                             .pSetLayouts = pipeline.setLayouts.data()};
    vkCheck(vkCreatePipelineLayout(device.device, &info, nullptr, &pipeline.layout), "vkCreatePipelineLayout",
            pipeline.label);
    device.name(VK_OBJECT_TYPE_PIPELINE_LAYOUT, pipeline.layout, pipeline.label);
}

void compile(PipelineState& pipeline, std::span<const uint32_t> spirv, const std::map<uint32_t, uint32_t>& values)
{
    const DeviceState& device = *pipeline.device;
    std::vector<VkSpecializationMapEntry> entries;
    std::vector<uint32_t> data;
    for (const auto& [id, value] : values) {
        entries.push_back({id, uint32_t(data.size() * sizeof(uint32_t)), sizeof(uint32_t)});
        data.push_back(value);
    }
    const VkSpecializationInfo specialization = {.mapEntryCount = uint32_t(entries.size()),
                                                 .pMapEntries = entries.data(),
                                                 .dataSize = data.size() * sizeof(uint32_t),
                                                 .pData = data.data()};
    const VkShaderModule module = createModule(device, spirv, pipeline.label);
    const VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .flags = VK_PIPELINE_CREATE_DISPATCH_BASE_BIT, // for bands (encoder.cpp)
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main",
                  .pSpecializationInfo = &specialization},
        .layout = pipeline.layout,
    };
    const auto start = Clock::now();
    const VkResult result =
        vkCreateComputePipelines(device.device, device.pipelineCache, 1, &info, nullptr, &pipeline.pipeline);
    pipeline.compileSeconds = secondsSince(start);
    vkDestroyShaderModule(device.device, module, nullptr);
    if (result == VK_ERROR_UNKNOWN || result == VK_ERROR_INITIALIZATION_FAILED || result == VK_ERROR_INVALID_SHADER_NV)
        throw Error("The driver of \"{}\" cannot compile shader \"{}\" (VkResult {}).", device.physical.adapter.name,
                    pipeline.label, int(result));
    vkCheck(result, "vkCreateComputePipelines", pipeline.label);
    device.name(VK_OBJECT_TYPE_PIPELINE, pipeline.pipeline, pipeline.label);
}

const char* nameOf(Usage usage)
{
    return usage == Usage::Storage ? "Storage" : usage == Usage::Uniform ? "Uniform" : "Table";
}

// The names given must be exactly those declared.
void checkNames(const BindGroupDescriptor& descriptor, std::span<const Binding> declared)
{
    std::vector<std::string> missing;
    std::vector<std::string> unknown;
    std::set<std::string> given;
    for (const auto& [name, buffer] : descriptor.buffers) {
        if (!given.insert(name).second) throw Error("Bind group \"{}\" names \"{}\" twice.", descriptor.label, name);
        if (!buffer || !buffer->state())
            throw Error("Bind group \"{}\" has no buffer for \"{}\".", descriptor.label, name);
        if (std::ranges::find(declared, name, &Binding::name) == declared.end()) unknown.push_back(name);
    }
    for (const Binding& binding : declared)
        if (!given.contains(binding.name)) missing.push_back(binding.name);
    if (missing.empty() && unknown.empty()) return;
    throw Error("Bind group \"{}\" does not fit set {} of pipeline \"{}\": missing [{}], unknown [{}].",
                descriptor.label, descriptor.set, descriptor.pipeline->label(), fmt::join(missing, ", "),
                fmt::join(unknown, ", "));
}

} // namespace

Usage usageFor(Binding::Kind kind)
{
    switch (kind) {
    case Binding::Kind::Storage: return Usage::Storage;
    case Binding::Kind::Uniform: return Usage::Uniform;
    case Binding::Kind::Table: return Usage::Table;
    }
    CHECK(false);
}

std::vector<uint32_t> DeviceState::loadShader(const std::string& shader) const
{
    const bool texel = tablesAreTexelBuffers();
    const bool isFile = shader.find('/') != std::string::npos;
    if (options.shaderDirectory.empty() || isFile) return gpu::loadShader(shader, texel);
    const std::filesystem::path directory = options.shaderDirectory;
    return compileShader(directory / (shader + ".comp"), directory, texel);
}

std::map<uint32_t, VkDescriptorType> DeviceState::descriptorsOf(const Binding& binding) const
{
    const uint32_t number = binding.binding;
    if (binding.kind == Binding::Kind::Uniform) return {{number, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}};
    if (binding.kind == Binding::Kind::Storage || !tablesAreTexelBuffers())
        return {{number, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
    if (!binding.writes) return {{number, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER}};
    return {{number, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER},
            {number + shared::STORES_BINDING, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
}

VkDescriptorSetLayout DeviceState::setLayout(const std::map<uint32_t, VkDescriptorType>& bindings)
{
    const std::lock_guard lock(setLayoutsMutex);
    VkDescriptorSetLayout& layout = setLayouts[bindings];
    if (layout) return layout;
    std::vector<VkDescriptorSetLayoutBinding> list;
    for (const auto& [number, type] : bindings)
        list.push_back({.binding = number,
                        .descriptorType = type,
                        .descriptorCount = 1,
                        .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT});
    const VkDescriptorSetLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                  .bindingCount = uint32_t(list.size()),
                                                  .pBindings = list.data()};
    vkCheck(vkCreateDescriptorSetLayout(device, &info, nullptr, &layout), "vkCreateDescriptorSetLayout", "set layout");
    name(VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, layout, fmt::format("layout of {} bindings", bindings.size()));
    return layout;
}

ComputePipeline Device::createComputePipeline(const ComputePipelineDescriptor& descriptor)
{
    return whileDoing(fmt::format("creating pipeline \"{}\"", descriptor.label), [&] {
        const Tuning& tuning = state_->physical.adapter.tuning;
        const std::string& shader = descriptor.shader.empty() ? descriptor.label : descriptor.shader;
        std::vector<uint32_t> spirv = state_->loadShader(shader);
        std::vector<Constant> constants = {{"LOOPS_TEST_AT_END", tuning.loops == Tuning::Loops::End},
                                           {"COUNTERS", uint32_t(tuning.counters)}};
        constants.insert(constants.end(), descriptor.constants.begin(), descriptor.constants.end()); // which win
        Reflection reflection = reflect(spirv, shader, state_->tablesAreTexelBuffers(), constants);
        checkLimits(*state_, reflection, shader);

        auto pipeline = std::make_unique<PipelineState>(*state_);
        pipeline->label = descriptor.label;
        pipeline->bindings = std::move(reflection.bindings);
        pipeline->workgroupSize = reflection.workgroupSize;
        for (const Constant& constant : constants)
            if (constant.name == "STORES_IN_STORAGE") pipeline->storesInStorage = constant.value != 0;
        createLayout(*pipeline);
        if (tuning.shaders == Tuning::Shaders::Pruned) spirv = std::move(reflection.pruned);
        if (tuning.contraction == Tuning::Contraction::Forbidden) spirv = withoutContraction(spirv);
        if (tuning.shaders == Tuning::Shaders::Simplified) spirv = simplified(spirv, shader, reflection.constants);
        compile(*pipeline, spirv, reflection.constants);
        return ComputePipeline(std::move(pipeline));
    });
}

BindGroup Device::createBindGroup(const BindGroupDescriptor& descriptor)
{
    CHECK(descriptor.pipeline && descriptor.pipeline->state());
    const PipelineState& pipeline = *descriptor.pipeline->state();
    std::vector<Binding> declared;
    for (const Binding& binding : pipeline.bindings)
        if (binding.set == descriptor.set) declared.push_back(binding);
    checkNames(descriptor, declared);
    CHECK_LT(descriptor.set, pipeline.setLayouts.size());

    auto group = std::make_unique<BindGroupState>(*state_);
    group->label = descriptor.label;
    group->set = descriptor.set;
    group->layout = pipeline.setLayouts[descriptor.set];

    std::vector<VkDescriptorPoolSize> sizes;
    for (const Binding& binding : declared)
        for (const auto& [number, type] : state_->descriptorsOf(binding)) sizes.push_back({type, 1});
    const VkDescriptorPoolCreateInfo poolInfo = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                                 .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
                                                 .maxSets = 1,
                                                 .poolSizeCount = uint32_t(sizes.size()),
                                                 .pPoolSizes = sizes.data()};
    vkCheck(vkCreateDescriptorPool(state_->device, &poolInfo, nullptr, &group->pool), "vkCreateDescriptorPool",
            descriptor.label);
    const VkDescriptorSetAllocateInfo setInfo = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                                 .descriptorPool = group->pool,
                                                 .descriptorSetCount = 1,
                                                 .pSetLayouts = &group->layout};
    vkCheck(vkAllocateDescriptorSets(state_->device, &setInfo, &group->descriptors), "vkAllocateDescriptorSets",
            descriptor.label);
    state_->name(VK_OBJECT_TYPE_DESCRIPTOR_SET, group->descriptors, descriptor.label);

    for (const Binding& binding : declared) {
        const auto entry = std::ranges::find(descriptor.buffers, binding.name, [](const auto& e) { return e.first; });
        const BufferState& buffer = *entry->second->state();
        const Usage usage = usageFor(binding.kind);
        if (!has(buffer.usage, usage))
            throw Error("Bind group \"{}\": buffer \"{}\" for \"{}\" lacks Usage::{}.", descriptor.label, buffer.label,
                        binding.name, nameOf(usage));
        const uint64_t most = state_->properties.limits.maxStorageBufferRange;
        const bool larger = buffer.size > most; // only tables are, and these are not written through a part of them
        CHECK(!larger || !binding.writes || !pipeline.storesInStorage);
        const VkDescriptorBufferInfo range = {buffer.buffer, 0, larger ? most : VK_WHOLE_SIZE};
        for (const auto& [number, type] : state_->descriptorsOf(binding)) {
            const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                                .dstSet = group->descriptors,
                                                .dstBinding = number,
                                                .descriptorCount = 1,
                                                .descriptorType = type,
                                                .pBufferInfo = &range,
                                                .pTexelBufferView = &buffer.view};
            vkUpdateDescriptorSets(state_->device, 1, &write, 0, nullptr);
        }
        group->buffers[binding.binding] = buffer.buffer;
    }
    return BindGroup(std::move(group));
}

PipelineState::~PipelineState()
{
    device->park([vk = device->device, layout = layout, pipeline = pipeline] {
        vkDestroyPipeline(vk, pipeline, nullptr);
        vkDestroyPipelineLayout(vk, layout, nullptr);
    });
}

BindGroupState::~BindGroupState()
{
    device->park([vk = device->device, pool = pool, set = descriptors] {
        if (set)
            vkFreeDescriptorSets(vk, pool, 1, &set); // lavapipe 22.3 keeps the names of sets that go with their pool
        vkDestroyDescriptorPool(vk, pool, nullptr);
    });
}

const std::string& ComputePipeline::label() const
{
    return state()->label;
}
std::span<const Binding> ComputePipeline::bindings() const
{
    return state()->bindings;
}
std::array<uint32_t, 3> ComputePipeline::workgroupSize() const
{
    return state()->workgroupSize;
}
double ComputePipeline::compileSeconds() const
{
    return state()->compileSeconds;
}

} // namespace gpu
