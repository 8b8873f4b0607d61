// What a compute shader declares, through SPIRV-Cross.

#include "engine/base/error.h"
#include "engine/gpu/instructions.h"
#include "engine/gpu/shader.h"

#include <spirv-tools/optimizer.hpp>
#include <spirv_cross/spirv_cross_c.h>

#include <algorithm>
#include <functional>
#include <unordered_map>

namespace gpu
{

namespace
{

struct DestroyContext {
    void operator()(spvc_context context) const { spvc_context_destroy(context); }
};
using Context = std::unique_ptr<spvc_context_s, DestroyContext>;

// One shader being looked at. Calls of SPIRV-Cross that can fail go through check().
struct Inspector {
    std::string label;
    Context context;
    spvc_compiler compiler = nullptr;

    void check(spvc_result result) const
    {
        if (result != SPVC_SUCCESS)
            throw Error("Shader \"{}\" is not usable SPIR-V: {}.", label,
                        context ? spvc_context_get_last_error_string(context.get()) : "no memory");
    }

    std::span<const spvc_reflected_resource> resources(spvc_resources all, spvc_resource_type type) const
    {
        const spvc_reflected_resource* list = nullptr;
        size_t count = 0;
        check(spvc_resources_get_resource_list_for_type(all, type, &list, &count));
        return {list, count};
    }

    // A table as a storage texel buffer (lib/lanes.glsl).
    bool isTableImage(const spvc_reflected_resource& image) const
    {
        const spvc_type type = spvc_compiler_get_type_handle(compiler, image.type_id);
        return spvc_type_get_image_dimension(type) == SpvDimBuffer;
    }

    // A block that is a table stored in a storage buffer: one member, named after the block (lib/lanes.glsl).
    bool isTableBlock(const spvc_reflected_resource& block) const
    {
        const spvc_type type = spvc_compiler_get_type_handle(compiler, block.base_type_id);
        return spvc_type_get_num_member_types(type) == 1 &&
               std::string(block.name) + "Elements" == spvc_compiler_get_member_name(compiler, block.base_type_id, 0);
    }

    Binding binding(const spvc_reflected_resource& resource, Binding::Kind kind) const
    {
        Binding result = {.name = resource.name,
                          .set = spvc_compiler_get_decoration(compiler, resource.id, SpvDecorationDescriptorSet),
                          .binding = spvc_compiler_get_decoration(compiler, resource.id, SpvDecorationBinding),
                          .kind = kind};
        if (kind == Binding::Kind::Table) {
            result.reads = !spvc_compiler_has_decoration(compiler, resource.id, SpvDecorationNonReadable);
            result.writes = !spvc_compiler_has_decoration(compiler, resource.id, SpvDecorationNonWritable);
        }
        if (kind != Binding::Kind::Storage) return result;
        const SpvDecoration* decorations = nullptr;
        size_t count = 0;
        check(spvc_compiler_get_buffer_block_decorations(compiler, resource.id, &decorations, &count));
        const std::span all(decorations, count);
        result.reads = std::ranges::find(all, SpvDecorationNonReadable) == all.end();
        result.writes = std::ranges::find(all, SpvDecorationNonWritable) == all.end();
        return result;
    }

    std::vector<Binding> bindings(bool tablesAreTexelBuffers) const
    {
        spvc_resources all = nullptr;
        check(spvc_compiler_create_shader_resources(compiler, &all));
        for (const auto& [type, what] : {std::pair(SPVC_RESOURCE_TYPE_PUSH_CONSTANT, "a push constant block"),
                                         std::pair(SPVC_RESOURCE_TYPE_STORAGE_IMAGE, "a storage image"),
                                         std::pair(SPVC_RESOURCE_TYPE_SEPARATE_IMAGE, "an image"),
                                         std::pair(SPVC_RESOURCE_TYPE_SAMPLED_IMAGE, "a sampled image")})
            for (const auto& r : resources(all, type))
                if (type != SPVC_RESOURCE_TYPE_STORAGE_IMAGE || !isTableImage(r))
                    throw Error("Shader \"{}\" declares {} (\"{}\"), which this program does not use.", label, what,
                                r.name);

        std::vector<Binding> found;
        for (const auto& r : resources(all, SPVC_RESOURCE_TYPE_UNIFORM_BUFFER))
            found.push_back(binding(r, Binding::Kind::Uniform));
        for (const auto& r : resources(all, SPVC_RESOURCE_TYPE_STORAGE_IMAGE))
            found.push_back(binding(r, Binding::Kind::Table));
        for (const auto& r : resources(all, SPVC_RESOURCE_TYPE_STORAGE_BUFFER)) {
            if (tablesAreTexelBuffers && isTableBlock(r)) continue; // the other binding of a table that is written
            found.push_back(binding(r, Binding::Kind::Storage));
            if (isTableBlock(r)) found.back().kind = Binding::Kind::Table;
        }
        std::ranges::sort(found, {}, [](const Binding& b) { return std::pair(b.set, b.binding); });
        return found;
    }

    // The constants' values by number, and the names of those that set the workgroup's size.
    void readConstants(std::span<const Constant> given, Reflection& result) const
    {
        spvc_specialization_constant sizes[3] = {};
        spvc_compiler_get_work_group_size_specialization_constants(compiler, &sizes[0], &sizes[1], &sizes[2]);
        const spvc_specialization_constant* list = nullptr;
        size_t count = 0;
        check(spvc_compiler_get_specialization_constants(compiler, &list, &count));
        for (const auto& constant : std::span(list, count)) {
            std::string name = spvc_compiler_get_name(compiler, constant.id);
            for (uint32_t axis = 0; axis < 3; ++axis)
                if (name.empty() && sizes[axis].id == constant.id) name = std::string("local_size_") + "xyz"[axis];
            const spvc_constant value = spvc_compiler_get_constant_handle(compiler, constant.id);
            // A number may be declared twice, as a name and as local_size_x_id: the first default counts for both.
            result.constants.try_emplace(constant.constant_id, spvc_constant_get_scalar_u32(value, 0, 0));
            for (uint32_t axis = 0; axis < 3; ++axis) {
                std::string& sizeName = result.workgroupSizeConstants[axis];
                const bool sets = sizes[axis].id != 0 && sizes[axis].constant_id == constant.constant_id;
                if (sets && (sizeName.empty() || sizeName.starts_with("local_size_"))) sizeName = name;
            }
            for (const Constant& wanted : given)
                if (wanted.name == name) result.constants[constant.constant_id] = wanted.value;
        }
    }

    void readWorkgroupSize(Reflection& result) const
    {
        for (uint32_t axis = 0; axis < 3; ++axis)
            result.workgroupSize[axis] =
                spvc_compiler_get_execution_mode_argument_by_index(compiler, SpvExecutionModeLocalSize, axis);
    }

    // Without padding: a lower bound that is exact for arrays of scalars, vec2 and vec4.
    uint64_t bytesOf(spvc_type type) const
    {
        uint64_t elements = 1;
        for (unsigned i = 0; i < spvc_type_get_num_array_dimensions(type); ++i)
            elements *= spvc_type_get_array_dimension(type, i);
        if (spvc_type_get_basetype(type) != SPVC_BASETYPE_STRUCT)
            return elements * spvc_type_get_vector_size(type) * spvc_type_get_columns(type) *
                   std::max(32u, spvc_type_get_bit_width(type)) / 8;
        uint64_t bytes = 0;
        for (unsigned i = 0; i < spvc_type_get_num_member_types(type); ++i)
            bytes += bytesOf(spvc_compiler_get_type_handle(compiler, spvc_type_get_member_type(type, i)));
        return elements * bytes;
    }

    // SPIRV-Cross does not list shared variables: look for OpVariable <type> <id> Workgroup among the instructions.
    uint64_t sharedBytes(std::span<const uint32_t> spirv) const
    {
        uint64_t bytes = 0;
        forEachInstruction(spirv, [&](SpvOp opcode, std::span<const uint32_t> words, size_t) {
            if (opcode == SpvOpVariable && words[3] == SpvStorageClassWorkgroup)
                bytes += bytesOf(spvc_compiler_get_type_handle(compiler, words[1]));
        });
        return bytes;
    }
};

Inspector inspect(std::span<const uint32_t> spirv, const std::string& label)
{
    spvc_context context = nullptr;
    Inspector inspector = {.label = label};
    inspector.check(spvc_context_create(&context));
    inspector.context.reset(context);
    spvc_parsed_ir ir = nullptr;
    inspector.check(spvc_context_parse_spirv(context, spirv.data(), spirv.size(), &ir));
    inspector.check(spvc_context_create_compiler(context, SPVC_BACKEND_NONE, ir, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP,
                                                 &inspector.compiler));
    return inspector;
}

// Drivers refuse a shader that names what they lack, used or not.
void dropUnusedSubgroupArithmetic(std::vector<uint32_t>& spirv)
{
    bool used = false;
    size_t named = 0;
    forEachInstruction(spirv, [&](SpvOp opcode, std::span<const uint32_t> words, size_t at) {
        used = used || (opcode >= SpvOpGroupNonUniformIAdd && opcode <= SpvOpGroupNonUniformLogicalXor);
        if (opcode == SpvOpCapability && words[1] == SpvCapabilityGroupNonUniformArithmetic) named = at;
    });
    const auto at = spirv.begin() + std::ptrdiff_t(named);
    if (named != 0 && !used) spirv.erase(at, at + 2);
}

// The same shader with its constants set for good, so that all sizes in it are plain numbers, after more passes.
std::vector<uint32_t> freeze(std::span<const uint32_t> spirv, const std::string& label,
                             const std::map<uint32_t, uint32_t>& constants,
                             const std::function<void(spvtools::Optimizer&)>& addPasses)
{
    std::unordered_map<uint32_t, std::vector<uint32_t>> values;
    for (const auto& [id, value] : constants) values[id] = {value};
    std::string problem;
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_2);
    optimizer.SetMessageConsumer(
        [&](spv_message_level_t, const char*, const spv_position_t&, const char* message) { problem = message; });
    optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
        .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
        .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass());
    addPasses(optimizer);
    std::vector<uint32_t> frozen;
    if (!optimizer.Run(spirv.data(), spirv.size(), &frozen))
        throw Error("Shader \"{}\" is not valid SPIR-V: {}.", label, problem);
    return frozen;
}

} // namespace

Reflection reflect(std::span<const uint32_t> spirv, const std::string& label, bool tablesAreTexelBuffers,
                   std::span<const Constant> constants)
{
    Reflection result;
    inspect(spirv, label).readConstants(constants, result);
    result.pruned = freeze(spirv, label, result.constants, [](spvtools::Optimizer& optimizer) {
        optimizer.RegisterPass(spvtools::CreateCCPPass())
            .RegisterPass(spvtools::CreateDeadBranchElimPass())
            .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
            .RegisterPass(spvtools::CreateAggressiveDCEPass(true)); // but bindings, used or not
    });
    const Inspector inspector = inspect(result.pruned, label);
    result.bindings = inspector.bindings(tablesAreTexelBuffers);
    inspector.readWorkgroupSize(result);
    result.sharedBytes = inspector.sharedBytes(result.pruned);
    return result;
}

std::vector<uint32_t> simplified(std::span<const uint32_t> spirv, const std::string& label,
                                 const std::map<uint32_t, uint32_t>& constants)
{
    std::vector<uint32_t> lean =
        freeze(spirv, label, constants, [](spvtools::Optimizer& optimizer) { optimizer.RegisterPerformancePasses(); });
    dropUnusedSubgroupArithmetic(lean);
    return lean;
}

} // namespace gpu
