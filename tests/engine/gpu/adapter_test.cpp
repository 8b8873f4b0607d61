// Covers engine/gpu/device.cpp, engine/gpu/instance.cpp.

#include "engine/base/error.h"
#include "engine/gpu/vulkan.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/program.h"

#include <cstdlib>

namespace
{

class Adapters : public GpuTest
{
};

std::string errorOf(const gpu::DeviceDescriptor& descriptor)
{
    try {
        gpu::Device::create(descriptor);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST_F(Adapters, AreListedInOrderWithWhatTheyCanDo)
{
    const std::vector<gpu::Adapter> adapters = gpu::enumerateAdapters();
    ASSERT_FALSE(adapters.empty());
    for (uint32_t i = 0; i < adapters.size(); ++i) {
        EXPECT_EQ(adapters[i].index, i);
        EXPECT_FALSE(adapters[i].name.empty());
        EXPECT_FALSE(adapters[i].driver.empty());
        const gpu::Limits& limits = adapters[i].limits;
        EXPECT_GE(limits.storageBindingBytes, uint64_t{128} << 20) << "WebGPU's default";
        EXPECT_GE(limits.uniformBindingBytes, uint64_t{16} << 10);
        EXPECT_LE(limits.storageBuffersPerStage, 10u);
        EXPECT_LE(limits.workgroupInvocations, 256u);
        EXPECT_LE(limits.workgroupBytes, 16384u);
        EXPECT_GT(limits.memoryBytes, 0u);
        EXPECT_GE(limits.tableBytes, uint64_t{128} << 20);
    }
}

TEST_F(Adapters, AreChosenByIndexAndByPartOfTheName)
{
    const gpu::Adapter expected = device().adapter();
    std::string part = expected.name.substr(1, 5);
    for (char& c : part) c = char(std::isupper(c) ? std::tolower(c) : std::toupper(c));
    EXPECT_EQ(gpu::Device::create({.adapter = part}).adapter().name, expected.name);
    EXPECT_EQ(gpu::Device::create({.adapter = std::to_string(expected.index)}).adapter().name, expected.name);
    EXPECT_NO_THROW(gpu::Device::create({}));
}

TEST_F(Adapters, DiscreteComesBeforeIntegratedBeforeCpu)
{
    const auto make = [](std::string name, std::string kind, uint32_t index) {
        return gpu::PhysicalDevice{.adapter = {.name = std::move(name), .kind = std::move(kind), .index = index}};
    };
    const std::vector devices = {make("Soft 8", "cpu", 0), make("Small", "integrated", 1), make("Big", "discrete", 2)};
    EXPECT_EQ(gpu::choose(devices, "").adapter.name, "Big");
    EXPECT_EQ(gpu::choose(std::span(devices).first(2), "").adapter.name, "Small");
    EXPECT_EQ(gpu::choose(std::span(devices).first(1), "").adapter.name, "Soft 8");
    EXPECT_EQ(gpu::choose(devices, "sMa").adapter.name, "Small");
    EXPECT_EQ(gpu::choose(devices, "0").adapter.name, "Soft 8");
    EXPECT_THROW(gpu::choose(devices, "8"), Error) << "a number is an index, not part of a name";
    EXPECT_THROW(gpu::choose(devices, "-1"), Error);
}

TEST_F(Adapters, AnUnknownNameIsAnErrorThatListsTheKnownOnes)
{
    const std::string message = errorOf({.adapter = "Voodoo 2"});
    EXPECT_NE(message.find("no Vulkan device \"Voodoo 2\"; available: "), std::string::npos) << message;
    EXPECT_NE(message.find("0: "), std::string::npos) << message;
    EXPECT_NE(message.find(device().adapter().name), std::string::npos) << message;
    EXPECT_NE(errorOf({.adapter = "99"}).find("no Vulkan device \"99\""), std::string::npos);
}

TEST_F(Adapters, NoDriverIsAnErrorAndAnEmptyList)
{
    const std::string before = std::getenv("VK_ICD_FILENAMES") ? std::getenv("VK_ICD_FILENAMES") : "";
    setenv("VK_ICD_FILENAMES", "/nonexistent.json", 1);
    EXPECT_TRUE(gpu::enumerateAdapters().empty());
    EXPECT_NE(errorOf({}).find("no Vulkan driver"), std::string::npos) << errorOf({});
    if (before.empty())
        unsetenv("VK_ICD_FILENAMES");
    else
        setenv("VK_ICD_FILENAMES", before.c_str(), 1);
}

// Such drivers (MoltenVK) say so in their manifest, and loaders hide them from who does not ask.
TEST_F(Adapters, DriversThatArePortableInPartsAreListedToo)
{
    const char* pinned = std::getenv("VK_ICD_FILENAMES");
    if (!pinned) GTEST_SKIP() << "SKIPPED, NOT TESTED: no driver is pinned whose manifest could be copied";
    const std::string before = pinned;
    const std::vector<gpu::Adapter> expected = gpu::enumerateAdapters();
    nlohmann::json manifest = readJson(before);
    std::filesystem::path library = std::string(manifest["ICD"]["library_path"]);
    if (library.has_parent_path()) library = std::filesystem::path(before).parent_path() / library; // if relative
    manifest["ICD"]["library_path"] = library.string();
    manifest["ICD"]["is_portability_driver"] = true;
    const TemporaryDirectory directory;
    writeFile(directory / "partly_portable.json", manifest.dump());
    setenv("VK_ICD_FILENAMES", (directory / "partly_portable.json").c_str(), 1);
    const std::vector<gpu::Adapter> found = gpu::enumerateAdapters();
    std::string adapter;
    EXPECT_NO_THROW(adapter = gpu::Device::create({}).adapter().name);
    setenv("VK_ICD_FILENAMES", before.c_str(), 1);
    ASSERT_EQ(found.size(), expected.size());
    for (size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].name, expected[i].name);
    EXPECT_EQ(adapter, expected.at(0).name);
}

TEST_F(Adapters, ValidationReportsOutOfOrderUse)
{
    // The messenger works: without it, silence would prove nothing.
    gpu::Device device = openDevice({});
    VkBuffer buffer = VK_NULL_HANDLE;
    const VkBufferCreateInfo empty = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    if (vkCreateBuffer(device.state().device, &empty, nullptr, &buffer) == VK_SUCCESS)
        vkDestroyBuffer(device.state().device, buffer, nullptr);
    EXPECT_FALSE(device.takeValidationMessages().empty());
    EXPECT_TRUE(device.takeValidationMessages().empty());
}

} // namespace
