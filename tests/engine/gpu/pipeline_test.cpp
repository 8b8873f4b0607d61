// Pipelines and bind groups by the shader's own names; limits.
// Covers engine/gpu/reflection.cpp.

#include "engine/base/error.h"
#include "engine/gpu/shader.h"
#include "tests/support/gpu_fixture.h"

#include <cmath>
#include <numeric>

namespace
{

using Words = std::vector<uint32_t>;
using Kind = gpu::Binding::Kind;

class Pipeline : public GpuTest
{
};

// The sentence of the Error that `work` throws; "" when it throws none.
template <class Work>
std::string errorOf(Work&& work)
{
    try {
        work();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

#define EXPECT_CONTAINS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST_F(Pipeline, RunsOnNamedBuffersWithNamedConstants)
{
    for (const uint32_t count : {1u, 63u, 64u, 1000u}) {
        Words values(count);
        std::iota(values.begin(), values.end(), 0u);
        Words table(4 * values.size());
        for (size_t i = 0; i < values.size(); ++i) table[4 * i] = uint32_t(3 * i);
        const gpu::Buffer buffer = upload("values", values);
        const gpu::Buffer elements = upload("elements", table, gpu::Usage::Table);
        const gpu::Buffer frame = upload("frame", Words{5}, gpu::Usage::Uniform);
        run({.shader = TEST_SPIRV_DIR "/pipeline_test",
             .constants = {{"OFFSET", 7}, {"NOT_IN_THE_SHADER", 1}},
             .buffers = {{"Values", &buffer}, {"Elements", &elements}, {"Frame", &frame}},
             .threads = {count}});
        const Words result = download<uint32_t>(buffer);
        ASSERT_EQ(result.size(), values.size());
        for (uint32_t i = 0; i < count; ++i) ASSERT_EQ(result[i], i * 5 + 7 + 3 * i);
    }
}

TEST_F(Pipeline, FetchesTablesOfBothFlavorsAtRandomPlaces)
{
    // Larger than the texel limit of the driver that has few: SwiftShader must have chosen storage buffers.
    constexpr uint32_t ELEMENTS = 100'000;
    constexpr uint32_t READS = 5'000;
    Words table(size_t{4} * ELEMENTS);
    for (uint32_t i = 0; i < table.size(); ++i) table[i] = i * 2654435761u;
    Words indices(READS);
    for (uint32_t i = 0; i < READS; ++i) indices[i] = i * 7919u % ELEMENTS;
    const gpu::Buffer elements = upload("elements", table, gpu::Usage::Table);
    const gpu::Buffer places = upload("indices", indices);
    const gpu::Buffer found = create<uint32_t>("found", size_t{4} * READS);
    run({.shader = TEST_SPIRV_DIR "/table_test",
         .buffers = {{"Elements", &elements}, {"Indices", &places}, {"Found", &found}},
         .threads = {READS}});
    const Words result = download<uint32_t>(found);
    for (uint32_t i = 0; i < READS; ++i)
        for (uint32_t lane = 0; lane < 4; ++lane) ASSERT_EQ(result[4 * i + lane], table[4 * indices[i] + lane]);
}

TEST_F(Pipeline, ReflectsTheSameBindingsFromBothFlavors)
{
    const std::vector<gpu::Binding> expected = {
        {.name = "Frame", .set = 0, .binding = 0, .kind = Kind::Uniform, .reads = true, .writes = false},
        {.name = "Elements", .set = 1, .binding = 3, .kind = Kind::Table, .reads = true, .writes = false},
        {.name = "Values", .set = 2, .binding = 1, .kind = Kind::Storage, .reads = true, .writes = true},
    };
    for (const bool texel : {true, false}) {
        const Words spirv = gpu::loadShader(TEST_SPIRV_DIR "/pipeline_test", texel);
        EXPECT_EQ(gpu::reflect(spirv, "test", texel, {}).bindings, expected);
    }
}

// Barriers come from this.
TEST_F(Pipeline, ReflectsWhichTablesAStageReadsAndWrites)
{
    for (const bool texel : {true, false})
        for (const gpu::Binding& binding :
             gpu::reflect(gpu::loadShader("temporal", texel), "temporal", texel, {}).bindings) {
            if (binding.set != 2 || binding.kind != Kind::Table) continue;
            EXPECT_TRUE(binding.reads) << binding.name;
            EXPECT_EQ(binding.writes, binding.name == "MergedColor" || binding.name.starts_with("Reservoir"))
                << binding.name;
        }
}

TEST_F(Pipeline, ReflectsReadonlyAndWriteonly)
{
    const gpu::Reflection shader =
        gpu::reflect(gpu::loadShader(TEST_SPIRV_DIR "/encoder_test", true), "test", true, {});
    ASSERT_EQ(shader.bindings.size(), 3u);
    EXPECT_EQ(shader.bindings[1].name, "From");
    EXPECT_TRUE(shader.bindings[1].reads && !shader.bindings[1].writes);
    EXPECT_EQ(shader.bindings[2].name, "To");
    EXPECT_TRUE(!shader.bindings[2].reads && shader.bindings[2].writes);
}

TEST_F(Pipeline, WorkgroupSizeAndSharedMemoryFollowTheConstants)
{
    const Words spirv = gpu::loadShader(TEST_SPIRV_DIR "/limits_test", true);
    const gpu::Reflection standard = gpu::reflect(spirv, "test", true, {});
    EXPECT_EQ(standard.workgroupSize, (std::array{8u, 4u, 1u}));
    EXPECT_EQ(standard.sharedBytes, 8 * 2 * 16 + 3 * 4u);
    const gpu::Constant constants[] = {{"WIDTH", 16}, {"local_size_y", 2}};
    const gpu::Reflection wide = gpu::reflect(spirv, "test", true, constants);
    EXPECT_EQ(wide.workgroupSize, (std::array{16u, 2u, 1u}));
    EXPECT_EQ(wide.sharedBytes, 16 * 2 * 16 + 3 * 4u);
}

// As lavapipe gets them: what is bound stays, used or not.
TEST_F(Pipeline, PrunedShadersHaveNoConstantsLeftAndAllBindings)
{
    const Words spirv = gpu::loadShader("path_trace", true);
    const gpu::Constant textures[] = {{"HAS_ALPHA", 0u}, {"HAS_BASE_COLOR_TEXTURE", 0u}};
    const gpu::Reflection all = gpu::reflect(spirv, "test", true, {});
    const gpu::Reflection before = gpu::reflect(spirv, "test", true, textures);
    const gpu::Reflection after = gpu::reflect(before.pruned, "test", true, {});
    ASSERT_GT(before.constants.size(), 20u);
    EXPECT_TRUE(after.constants.empty());
    EXPECT_EQ(after.workgroupSize, before.workgroupSize);
    EXPECT_EQ(after.bindings, all.bindings);
    EXPECT_LT(before.pruned.size(), all.pruned.size());
    EXPECT_LT(all.pruned.size(), spirv.size());
}

// As SwiftShader gets them.
TEST_F(Pipeline, SimplifiedShadersHaveNoConstantsLeftAndNothingUnused)
{
    const Words spirv = gpu::loadShader("spatial_trace", false);
    const gpu::Constant reservoirs{"RESERVOIR_COUNT", 3u};
    const gpu::Reflection before = gpu::reflect(spirv, "test", false, std::span(&reservoirs, 1));
    ASSERT_GT(before.constants.size(), 20u);
    const Words lean = gpu::simplified(spirv, "test", before.constants);
    const gpu::Reflection after = gpu::reflect(lean, "test", false, {});
    EXPECT_TRUE(after.constants.empty());
    EXPECT_EQ(after.workgroupSize, before.workgroupSize);
    std::vector<gpu::Binding> used = before.bindings; // random replay, the default, keeps no paths
    EXPECT_EQ(std::erase_if(used, [](const gpu::Binding& b) { return b.name == "ReservoirPaths"; }), 1u);
    ASSERT_EQ(after.bindings.size(), used.size());
    for (size_t i = 0; i < used.size(); ++i) EXPECT_EQ(after.bindings[i], used[i]) << used[i].name;
    EXPECT_THROW(gpu::simplified(Words{1, 2, 3}, "garbage", {}), Error);
}

TEST_F(Pipeline, ConstantsReachTheWorkgroupSizeOnTheDevice)
{
    const gpu::Buffer sizes = create<uint32_t>("sizes", 4);
    run({.shader = TEST_SPIRV_DIR "/limits_test",
         .constants = {{"WIDTH", 32}, {"local_size_y", 2}},
         .buffers = {{"Sizes", &sizes}}});
    EXPECT_EQ(download<uint32_t>(sizes), (Words{32, 2, 1, 64}));
}

TEST_F(Pipeline, LimitsAreErrorsThatNameTheConstant)
{
    const auto create = [&](std::vector<gpu::Constant> constants) {
        return errorOf([&] {
            device().createComputePipeline(
                {.label = "limits", .shader = TEST_SPIRV_DIR "/limits_test", .constants = constants});
        });
    };
    EXPECT_EQ(create({{"WIDTH", 64}}), "");
    const std::string wide = create({{"WIDTH", 128}});
    EXPECT_CONTAINS(wide, "128 x 4 x 1");
    EXPECT_CONTAINS(create({{"WIDTH", 1024}}), "reduce the constant WIDTH");
    EXPECT_CONTAINS(create({{"WIDTH", 0}}), "0 x 4 x 1");
    EXPECT_CONTAINS(create({{"EXTRA", 5000}}), "bytes of shared memory");
}

TEST_F(Pipeline, BindGroupsListMissingUnknownAndUnfitBuffers)
{
    const gpu::ComputePipeline pipeline =
        device().createComputePipeline({.label = "named", .shader = TEST_SPIRV_DIR "/encoder_test"});
    const gpu::Buffer buffer = create<uint32_t>("numbers", 16);
    const gpu::Buffer uniform = create<uint32_t>("constants", 16, gpu::Usage::Uniform);
    const auto bind = [&](std::vector<std::pair<std::string, const gpu::Buffer*>> buffers) {
        return errorOf(
            [&] { device().createBindGroup({.label = "group", .pipeline = &pipeline, .set = 2, .buffers = buffers}); });
    };
    const gpu::Buffer other = create<uint32_t>("other", 16);
    EXPECT_EQ(bind({{"From", &buffer}, {"To", &other}}), "");
    const std::string wrong = bind({{"From", &buffer}, {"Two", &other}});
    EXPECT_CONTAINS(wrong, "\"group\" does not fit set 2 of pipeline \"named\"");
    EXPECT_CONTAINS(wrong, "missing [To], unknown [Two]");
    EXPECT_CONTAINS(bind({{"From", &buffer}, {"To", &uniform}}),
                    "buffer \"constants\" for \"To\" lacks Usage::Storage");
    EXPECT_CONTAINS(bind({{"From", &buffer}, {"To", nullptr}}), "no buffer for \"To\"");
    EXPECT_CONTAINS(bind({{"From", &buffer}, {"From", &other}}), "names \"From\" twice");
}

TEST_F(Pipeline, WhatIsNoShaderIsAnError)
{
    EXPECT_CONTAINS(errorOf([&] { device().createComputePipeline({.label = "no_such_stage"}); }),
                    "no shader \"no_such_stage\"");
    EXPECT_CONTAINS(errorOf([&] { device().createComputePipeline({.label = "x", .shader = "/nowhere/x"}); }),
                    "While creating pipeline \"x\"");
    EXPECT_THROW(gpu::reflect(Words{1, 2, 3}, "garbage", true, {}), Error);
    Words cut = gpu::loadShader(TEST_SPIRV_DIR "/encoder_test", true);
    cut.resize(cut.size() / 2);
    EXPECT_THROW(gpu::reflect(cut, "cut", true, {}), Error);
}

} // namespace
