#pragma once
// The fixture of GPU tests, and the shortest introduction to engine/gpu: open a device, run a kernel, read back.
//
//     // square_test.comp: layout(set = SET_PASS, binding = 0) buffer Values { uint values[]; }; ...
//     class Square : public GpuTest {};
//     TEST_F(Square, IsItselfTimesItself)
//     {
//         gpu::Buffer values = upload("values", std::vector<uint32_t>{1, 2, 3});
//         run({.shader = TEST_SPIRV_DIR "/square_test", .buffers = {{"Values", &values}}, .threads = {3}});
//         EXPECT_EQ(download<uint32_t>(values), (std::vector<uint32_t>{1, 4, 9}));
//     }
//
// The device is TRICHROME_TEST_DEVICE (default "llvmpipe"), opened once per executable, with synchronization
// validation: a validation message fails the test that caused it. TRICHROME_TEST_TUNING overrides what its class gets,
// as
// --device-tuning does.

#include "engine/gpu/gpu.h"

#include <gtest/gtest.h>

// SwiftShader takes five times as long as lavapipe to run a kernel, and up to minutes to compile it: 15 s for the
// stages of a simple scene, minutes where all kinds of materials are in it.
inline bool isSlow(const gpu::Device& device)
{
    return device.adapter().name.find("SwiftShader") != std::string::npos;
}

class GpuTest : public testing::Test
{
  protected:
    struct Run {
        std::string shader;                   // TEST_SPIRV_DIR "/X_test", or the name of an embedded shader
        std::vector<gpu::Constant> constants; // by name
        std::vector<std::pair<std::string, const gpu::Buffer*>> buffers; // by name, of all the kernel's sets
        gpu::Threads threads;
    };

    static gpu::Device& device();

    // Another device of the same driver, for tests of devices; whoever opens one looks at its messages.
    static gpu::Device openDevice(gpu::DeviceDescriptor descriptor);

    // Compiles (once per shader and constants), binds, dispatches, submits and waits.
    void run(const Run& run);

    // A zero-filled buffer of `count` elements.
    template <class T>
    gpu::Buffer create(const std::string& label, size_t count, gpu::Usage usage = gpu::Usage::Storage)
    {
        return device().createBuffer({.label = label, .size = count * sizeof(T), .usage = usage});
    }
    template <class T>
    gpu::Buffer upload(const std::string& label, const std::vector<T>& values, gpu::Usage usage = gpu::Usage::Storage)
    {
        gpu::Buffer buffer = create<T>(label, values.size(), usage);
        device().queue().write(buffer, std::as_bytes(std::span(values)));
        return buffer;
    }
    template <class T>
    std::vector<T> download(const gpu::Buffer& buffer)
    {
        return device().queue().readAs<T>(buffer);
    }

    void SetUp() override;    // skips when the driver is not installed
    void TearDown() override; // fails on any validation message

  private:
    static const gpu::ComputePipeline& pipeline(const Run& run);
};

// For tests that run whole renderers.
class RendererFixture : public GpuTest
{
  protected:
    void SetUp() override
    {
        GpuTest::SetUp();
        if (!IsSkipped() && isSlow(device()))
            GTEST_SKIP() << "SKIPPED ON SwiftShader: compiling takes minutes there; drivers_agreement_test compares "
                            "its pictures";
    }
};
