#include "engine/base/error.h"
#include "shaders/shared/types.h"
#include "tests/support/gpu_fixture.h"

#include <algorithm>

namespace
{

class Buffer : public GpuTest
{
};

TEST_F(Buffer, StartsAsZeros)
{
    for (int i = 0; i < 3; ++i) { // later ones may get memory that was used
        gpu::Buffer buffer = create<uint32_t>("zeros", 1000);
        EXPECT_EQ(download<uint32_t>(buffer), std::vector<uint32_t>(1000, 0));
        device().queue().write(buffer, std::vector<std::byte>(4000, std::byte{0xff}));
    }
}

TEST_F(Buffer, CountsItsMemoryUntilItGoes)
{
    const uint64_t before = device().allocatedBytes();
    {
        const gpu::Buffer buffer = create<uint32_t>("counted", 1 << 18);
        EXPECT_GE(device().allocatedBytes(), before + (1 << 20));
        EXPECT_EQ(buffer.size(), 1u << 20);
        EXPECT_EQ(buffer.label(), "counted");
    }
    EXPECT_EQ(device().allocatedBytes(), before);
}

TEST_F(Buffer, TooLargeForItsUsageIsAnErrorThatNamesTheSetting)
{
    const gpu::Limits& limits = device().limits();
    const auto errorFor = [&](gpu::Usage usage, uint64_t size) -> std::string {
        try {
            device().createBuffer({.label = "reservoirs", .size = size, .usage = usage, .setting = "--size"});
        } catch (const Error& error) {
            return error.what();
        }
        return "no error";
    };
    for (const auto& [usage, limit] : {std::pair(gpu::Usage::Storage, limits.storageBindingBytes),
                                       std::pair(gpu::Usage::Uniform, limits.uniformBindingBytes),
                                       std::pair(gpu::Usage::Table, limits.tableBytes)}) {
        const std::string message = errorFor(usage, limit + 1);
        EXPECT_NE(message.find("\"reservoirs\" needs " + std::to_string(limit + 1)), std::string::npos) << message;
        EXPECT_NE(message.find("reduce --size"), std::string::npos) << message;
    }
    EXPECT_NE(errorFor(gpu::Usage::Readback, uint64_t{1} << 50).find("reduce --size"), std::string::npos);
}

// Where a picture's buffers lie: beyond what a storage buffer may hold, and before the end of what is asked for; what a
// storage buffer holds is written by either binding (shaders/lib/lanes.glsl).
TEST_F(Buffer, AsATableIsReadAndWrittenBeyondTheLargestStorageBinding)
{
    const gpu::Limits& limits = device().limits();
    const uint32_t count = 100;
    for (const auto& [bytes, inStorage] :
         {std::pair(std::min((uint64_t{128} << 20) + 4096, limits.tableBytes), false), {8192, false}, {8192, true}}) {
        const uint32_t rows = uint32_t(bytes / sizeof(glm::uvec4));
        gpu::Buffer table = create<glm::uvec4>("rows", rows, gpu::Usage::Table);
        std::vector<glm::uvec4> low, high;
        for (uint32_t i = 0; i < count; ++i) {
            low.emplace_back(i, 1, 2, 3);
            high.emplace_back(4, 5, 6, i);
        }
        const uint64_t end = uint64_t{rows - count} * sizeof(glm::uvec4);
        device().queue().write(table, std::as_bytes(std::span(low)));
        device().queue().write(table, std::as_bytes(std::span(high)), end);
        const gpu::Buffer ends = upload("ends", std::vector<uint32_t>{0, rows - 1, count, 0});
        run({.shader = TEST_SPIRV_DIR "/large_table_test",
             .constants = {{"STORES_IN_STORAGE", inStorage}},
             .buffers = {{"Rows", &table}, {"Ends", &ends}},
             .threads = {count}});
        std::vector<glm::uvec4> found = download<glm::uvec4>(table);
        std::ranges::reverse(low);
        std::ranges::reverse(high);
        EXPECT_EQ(std::vector(found.begin(), found.begin() + count), high) << bytes << " bytes, " << inStorage;
        EXPECT_EQ(std::vector(found.end() - count, found.end()), low) << bytes << " bytes, " << inStorage;
    }
}

TEST_F(Buffer, OfOddSizeKeepsItsLastBytes)
{
    std::vector<uint8_t> bytes(37);
    for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = uint8_t(i + 1);
    for (const gpu::Usage usage : {gpu::Usage::Storage, gpu::Usage::Uniform, gpu::Usage::Table, gpu::Usage::Readback}) {
        const gpu::Buffer buffer = upload("odd", bytes, usage);
        EXPECT_EQ(download<uint8_t>(buffer), bytes);
    }
}

} // namespace
