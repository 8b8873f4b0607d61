// What a compute shader declares, through SPIRV-Cross.

#include "engine/base/error.h"
#include "engine/gpu/shader.h"

#include <spirv_cross/spirv_cross_c.h>

#include <algorithm>

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
    const std::string& label;
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

    // A block that is a table stored in a storage buffer: read-only, one member, named after the block
    // (lib/table.glsl).
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
                                         std::pair(SPVC_RESOURCE_TYPE_SAMPLED_IMAGE, "a sampled image")})
            if (const auto found = resources(all, type); !found.empty())
                throw Error("Shader \"{}\" declares {} (\"{}\"), which this program does not use.", label, what,
                            found[0].name);

        std::vector<Binding> found;
        for (const auto& r : resources(all, SPVC_RESOURCE_TYPE_UNIFORM_BUFFER))
            found.push_back(binding(r, Binding::Kind::Uniform));
        for (const auto& r : resources(all, SPVC_RESOURCE_TYPE_SEPARATE_IMAGE))
            found.push_back(binding(r, Binding::Kind::Table));
        for (const auto& r : resources(all, SPVC_RESOURCE_TYPE_STORAGE_BUFFER)) {
            found.push_back(binding(r, Binding::Kind::Storage));
            if (!tablesAreTexelBuffers && !found.back().writes && isTableBlock(r))
                found.back().kind = Binding::Kind::Table;
        }
        std::ranges::sort(found, {}, [](const Binding& b) { return std::pair(b.set, b.binding); });
        return found;
    }

    Extent extent(uint32_t literal, spvc_constant_id id) const
    {
        if (id == 0) return {literal, std::nullopt};
        const spvc_constant constant = spvc_compiler_get_constant_handle(compiler, id);
        Extent result = {spvc_constant_get_scalar_u32(constant, 0, 0), std::nullopt};
        if (spvc_compiler_has_decoration(compiler, id, SpvDecorationSpecId))
            result.constantId = spvc_compiler_get_decoration(compiler, id, SpvDecorationSpecId);
        return result;
    }

    void constants(Reflection& result) const
    {
        spvc_specialization_constant sizes[3] = {};
        spvc_compiler_get_work_group_size_specialization_constants(compiler, &sizes[0], &sizes[1], &sizes[2]);
        for (uint32_t axis = 0; axis < 3; ++axis) {
            const uint32_t literal =
                spvc_compiler_get_execution_mode_argument_by_index(compiler, SpvExecutionModeLocalSize, axis);
            result.workgroupSize[axis] = extent(literal, sizes[axis].id);
        }

        const spvc_specialization_constant* list = nullptr;
        size_t count = 0;
        check(spvc_compiler_get_specialization_constants(compiler, &list, &count));
        for (const auto& constant : std::span(list, count)) {
            std::string name = spvc_compiler_get_name(compiler, constant.id);
            for (uint32_t axis = 0; axis < 3; ++axis)
                if (name.empty() && constant.id == sizes[axis].id) name = std::string("local_size_") + "xyz"[axis];
            const spvc_constant value = spvc_compiler_get_constant_handle(compiler, constant.id);
            result.constants.push_back({name, constant.constant_id, spvc_constant_get_scalar_u32(value, 0, 0)});
        }
    }
};

} // namespace

Reflection reflect(std::span<const uint32_t> spirv, const std::string& label, bool tablesAreTexelBuffers)
{
    spvc_context context = nullptr;
    Inspector inspector = {.label = label};
    inspector.check(spvc_context_create(&context));
    inspector.context.reset(context);
    spvc_parsed_ir ir = nullptr;
    inspector.check(spvc_context_parse_spirv(context, spirv.data(), spirv.size(), &ir));
    inspector.check(spvc_context_create_compiler(context, SPVC_BACKEND_NONE, ir, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP,
                                                 &inspector.compiler));

    Reflection result;
    result.bindings = inspector.bindings(tablesAreTexelBuffers);
    inspector.constants(result);
    return result;
}

} // namespace gpu
