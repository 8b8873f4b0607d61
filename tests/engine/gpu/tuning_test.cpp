// What is chosen by device class, and overrides.

#include "engine/base/error.h"
#include "engine/gpu/shader.h"
#include "tests/support/gpu_fixture.h"

namespace
{

using gpu::DeviceClass;
using gpu::Tuning;

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

std::string chosenFor(const DeviceClass& device)
{
    return gpu::toText(gpu::tuningFor(device));
}

constexpr DeviceClass LAVAPIPE = {.cpu = true, .texelTables = true, .subgroupSums = true};
constexpr DeviceClass SWIFTSHADER = {.cpu = true, .texelTables = false, .subgroupSums = true};
constexpr DeviceClass CARD = {.cpu = false, .texelTables = true, .subgroupSums = true};
constexpr DeviceClass POOR_CARD = {.cpu = false, .texelTables = false, .subgroupSums = false};

TEST(DeviceTuning, FollowsTheDevicesClass)
{
    EXPECT_EQ(chosenFor(LAVAPIPE),
              "tables=texel,loops=end,stack=registers,counters=each,contraction=allowed,shaders=pruned");
    EXPECT_EQ(chosenFor(SWIFTSHADER),
              "tables=storage,loops=start,stack=array,counters=each,contraction=allowed,shaders=simplified");
    EXPECT_EQ(chosenFor(CARD),
              "tables=storage,loops=start,stack=array,counters=subgroup,contraction=forbidden,shaders=plain");
    EXPECT_EQ(chosenFor(POOR_CARD),
              "tables=storage,loops=start,stack=array,counters=each,contraction=forbidden,shaders=simplified");
}

TEST(DeviceTuning, OfEveryClassIsPossibleThere)
{
    for (const bool cpu : {true, false})
        for (const bool texel : {true, false})
            for (const bool sums : {true, false}) {
                const DeviceClass device = {cpu, texel, sums};
                EXPECT_EQ(errorOf([&] { gpu::requirePossible(gpu::tuningFor(device), device, "x"); }), "");
            }
}

// Each choice alone: no other one follows it.
TEST(DeviceTuning, IsOverriddenOneByOne)
{
    for (const gpu::TuningText& text : gpu::describe({}))
        for (const std::string& value : text.values) {
            Tuning tuning = gpu::tuningFor(LAVAPIPE);
            std::vector<gpu::TuningText> expected = gpu::describe(tuning);
            gpu::applyOverrides(tuning, text.name + "=" + value);
            const std::vector<gpu::TuningText> found = gpu::describe(tuning);
            for (size_t i = 0; i < expected.size(); ++i)
                EXPECT_EQ(found[i].value, expected[i].name == text.name ? value : expected[i].value);
        }
    Tuning tuning = gpu::tuningFor(CARD);
    gpu::applyOverrides(tuning, "tables=texel,counters=off");
    EXPECT_EQ(gpu::toText(tuning),
              "tables=texel,loops=start,stack=array,counters=off,contraction=forbidden,shaders=plain");
    Tuning all;
    gpu::applyOverrides(all, gpu::toText(tuning));
    EXPECT_EQ(all, tuning);
}

TEST(DeviceTuning, RefusesWhatItDoesNotKnow)
{
    const auto refusal = [](const std::string& list) {
        return errorOf([&] {
            Tuning tuning;
            gpu::applyOverrides(tuning, list);
        });
    };
    EXPECT_EQ(refusal(""), "");
    EXPECT_EQ(refusal("table=texel"),
              "There is no device tuning \"table\"; there are: tables, loops, stack, counters, contraction, shaders.");
    EXPECT_EQ(refusal("loops=end,counters=all"),
              "\"all\" is no value of the device tuning \"counters\"; there are: each, subgroup, off.");
    EXPECT_EQ(refusal("loops=end,loops=start"), "The device tuning \"loops\" is given twice.");
    EXPECT_EQ(refusal("loops"), "\"loops\" is not of the form NAME=VALUE,... of device tunings.");
    EXPECT_EQ(refusal("loops=end,,"), "\"\" is not of the form NAME=VALUE,... of device tunings.");
}

TEST(DeviceTuning, RefusesWhatADeviceCannotDo)
{
    const auto refusal = [](const std::string& list) {
        return errorOf([&] {
            Tuning tuning = gpu::tuningFor(POOR_CARD);
            gpu::applyOverrides(tuning, list);
            gpu::requirePossible(tuning, POOR_CARD, "Voodoo 2");
        });
    };
    EXPECT_NE(refusal("tables=texel").find("tables=texel is beyond \"Voodoo 2\""), std::string::npos);
    EXPECT_NE(refusal("counters=subgroup").find("counters=subgroup is beyond \"Voodoo 2\""), std::string::npos);
    EXPECT_NE(refusal("shaders=plain").find("shaders=plain is beyond \"Voodoo 2\""), std::string::npos);
}

class TunedDevice : public GpuTest
{
};

TEST_F(TunedDevice, HasWhatItWasOpenedWith)
{
    gpu::Device storage = openDevice({.tuning = "tables=storage"});
    EXPECT_EQ(storage.adapter().tuning.tables, Tuning::Tables::Storage);
    EXPECT_EQ(storage.limits().tableBytes, storage.limits().storageBindingBytes);
    EXPECT_TRUE(storage.takeValidationMessages().empty());
    EXPECT_EQ(errorOf([&] { openDevice({.tuning = "counters=none"}); }),
              "\"none\" is no value of the device tuning \"counters\"; there are: each, subgroup, off.");
    for (const gpu::Adapter& adapter : gpu::enumerateAdapters("loops=start"))
        EXPECT_EQ(adapter.tuning.loops, Tuning::Loops::Start);
}

// A driver without subgroup arithmetic may not even see its name.
TEST_F(TunedDevice, SimplifiedShadersNameNoSubgroupArithmeticUnlessCountersUseIt)
{
    const auto names = [](uint32_t counters) {
        const std::vector<uint32_t> spirv = gpu::loadShader("primary", false);
        const gpu::Constant constant{"COUNTERS", counters};
        const gpu::Reflection shader = gpu::reflect(spirv, "test", false, std::span(&constant, 1));
        const std::vector<uint32_t> lean = gpu::simplified(spirv, "test", shader.constants);
        constexpr uint32_t CAPABILITY = 2u << 16 | 17u, ARITHMETIC = 63u;
        for (size_t i = 5; i < lean.size() && lean[i] == CAPABILITY; i += 2)
            if (lean[i + 1] == ARITHMETIC) return true;
        return false;
    };
    EXPECT_FALSE(names(uint32_t(Tuning::Counters::Each)));
    EXPECT_FALSE(names(uint32_t(Tuning::Counters::Off)));
    EXPECT_TRUE(names(uint32_t(Tuning::Counters::Subgroup)));
}

} // namespace
