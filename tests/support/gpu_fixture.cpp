#include "tests/support/gpu_fixture.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

namespace
{

// Software drivers that tests know how to find. Pinned, so that the loader need not try the drivers of absent GPUs.
struct KnownDriver {
    std::string device; // part of its device's name
    const char* manifest;
    const char* package;
};
const KnownDriver DRIVERS[] = {
    {"llvmpipe", "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json", "mesa-vulkan-drivers"},
    {"SwiftShader", "/usr/lib/chromium/vk_swiftshader_icd.json", "chromium"},
};

std::string wantedDevice()
{
    const char* wanted = std::getenv("TRICHROME_TEST_DEVICE");
    return wanted ? wanted : DRIVERS[0].device;
}

// Why the wanted device's driver cannot be used; empty when it can be tried.
std::string pinDriver()
{
    // Whoever has pinned a driver that we do not know (a newer build of one) knows better.
    const char* pinned = std::getenv("VK_ICD_FILENAMES");
    if (pinned &&
        std::ranges::none_of(DRIVERS, [&](const KnownDriver& d) { return pinned == std::string(d.manifest); }))
        return "";
    for (const KnownDriver& driver : DRIVERS) {
        if (driver.device != wantedDevice()) continue;
        if (!std::filesystem::exists(driver.manifest))
            return "SKIPPED, NOT TESTED ON " + driver.device + ": no " + driver.manifest + " (Debian package " +
                   driver.package + ")";
        setenv("VK_ICD_FILENAMES", driver.manifest, 1);
    }
    return "";
}

// Device and pipelines of this executable, closed before main returns: drivers dislike closing later.
struct Shared {
    std::optional<gpu::Device> device;
    std::map<std::string, gpu::ComputePipeline> pipelines; // goes before the device
};
Shared shared;

class CloseAtTheEnd : public testing::Environment
{
  public:
    void TearDown() override
    {
        shared.pipelines.clear();
        shared.device.reset();
    }
};
[[maybe_unused]] testing::Environment* const closer = testing::AddGlobalTestEnvironment(new CloseAtTheEnd);

} // namespace

gpu::Device GpuTest::openDevice(gpu::DeviceDescriptor descriptor)
{
    descriptor.adapter = wantedDevice();
    descriptor.validation = true;
    const char* tuning = std::getenv("TRICHROME_TEST_TUNING");
    if (tuning && descriptor.tuning.empty()) descriptor.tuning = tuning;
    return gpu::Device::create(descriptor);
}

gpu::Device& GpuTest::device()
{
    if (!shared.device) shared.device = openDevice({});
    return *shared.device;
}

const gpu::ComputePipeline& GpuTest::pipeline(const Run& run)
{
    std::string key = run.shader;
    for (const gpu::Constant& constant : run.constants)
        key += " " + constant.name + "=" + std::to_string(constant.value);
    const auto found = shared.pipelines.find(key);
    if (found != shared.pipelines.end()) return found->second;
    gpu::ComputePipeline created =
        device().createComputePipeline({.label = key, .shader = run.shader, .constants = run.constants});
    return shared.pipelines.emplace(key, std::move(created)).first->second;
}

void GpuTest::run(const Run& run)
{
    const gpu::ComputePipeline& kernel = pipeline(run);

    // One bind group per set that the kernel declares; each takes the buffers that it names.
    std::map<uint32_t, gpu::BindGroupDescriptor> descriptors;
    std::set<std::string> unused;
    for (const auto& [name, buffer] : run.buffers) unused.insert(name);
    for (const gpu::Binding& binding : kernel.bindings()) {
        gpu::BindGroupDescriptor& descriptor = descriptors[binding.set];
        descriptor.label = run.shader;
        descriptor.pipeline = &kernel;
        descriptor.set = binding.set;
        for (const auto& entry : run.buffers)
            if (entry.first == binding.name) descriptor.buffers.push_back(entry);
        unused.erase(binding.name);
    }
    ASSERT_TRUE(unused.empty()) << "the kernel " << run.shader << " declares no " << *unused.begin();

    std::map<uint32_t, gpu::BindGroup> groups;
    gpu::Dispatch dispatch = {.pipeline = &kernel, .threads = run.threads};
    for (const auto& [set, descriptor] : descriptors) {
        groups.emplace(set, device().createBindGroup(descriptor));
        dispatch.groups.resize(set + 1);
        dispatch.groups[set] = &groups.at(set);
    }

    gpu::CommandEncoder encoder = device().createCommandEncoder(run.shader);
    encoder.dispatch(dispatch);
    device().queue().wait(device().queue().submit(std::move(encoder)));
}

void GpuTest::SetUp()
{
    const std::string reason = pinDriver();
    if (!reason.empty()) GTEST_SKIP() << reason;
    if (shared.device) shared.device->takeValidationMessages();
}

void GpuTest::TearDown()
{
    if (!shared.device) return;
    for (const std::string& message : shared.device->takeValidationMessages()) ADD_FAILURE() << message;
}
