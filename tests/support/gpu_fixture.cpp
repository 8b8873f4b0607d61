#include "tests/support/gpu_fixture.h"

#include <cstdlib>
#include <map>
#include <set>

namespace
{

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

gpu::Device& GpuTest::device()
{
    if (!shared.device) {
        const char* wanted = std::getenv("TRICHROME_TEST_DEVICE");
        shared.device = gpu::Device::create({.adapter = wanted ? wanted : "llvmpipe", .validation = true});
    }
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
    device().takeValidationMessages();
}

void GpuTest::TearDown()
{
    for (const std::string& message : device().takeValidationMessages()) ADD_FAILURE() << message;
}
