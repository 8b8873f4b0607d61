#include "engine/gpu/pipeline_cache.h"

#include "engine/base/files.h"
#include "engine/gpu/vulkan.h"
#include "tests/support/gpu_fixture.h"

#include <filesystem>
#include <fstream>

namespace
{

namespace fs = std::filesystem;
using Bytes = std::vector<std::byte>;

const gpu::CacheOwner OWNER = {.vendor = 1, .device = 2, .driverVersion = 3, .uuid = {4, 5, 6}};
const Bytes BLOB = {std::byte{10}, std::byte{20}, std::byte{30}};

TEST(PipelineCacheFile, GivesBackWhatWasSealed)
{
    EXPECT_EQ(gpu::openCache(OWNER, gpu::sealCache(OWNER, BLOB)), BLOB);
    EXPECT_EQ(gpu::openCache(OWNER, gpu::sealCache(OWNER, {})), Bytes{});
}

TEST(PipelineCacheFile, IsRefusedWhenAnyBitIsWrong)
{
    const Bytes file = gpu::sealCache(OWNER, BLOB);
    for (size_t i = 0; i < file.size(); ++i)
        for (int bit = 0; bit < 8; ++bit) {
            Bytes damaged = file;
            damaged[i] ^= std::byte(1 << bit);
            EXPECT_EQ(gpu::openCache(OWNER, damaged), std::nullopt) << "byte " << i << " bit " << bit;
        }
}

TEST(PipelineCacheFile, IsRefusedAtAnyOtherLength)
{
    const Bytes file = gpu::sealCache(OWNER, BLOB);
    for (size_t length = 0; length < file.size(); ++length)
        EXPECT_EQ(gpu::openCache(OWNER, std::span(file).first(length)), std::nullopt) << length;
    Bytes longer = file;
    longer.push_back(std::byte{0});
    EXPECT_EQ(gpu::openCache(OWNER, longer), std::nullopt);
}

TEST(PipelineCacheFile, IsRefusedFromAnotherDriver)
{
    const Bytes file = gpu::sealCache(OWNER, BLOB);
    gpu::CacheOwner other = OWNER;
    other.driverVersion += 1;
    EXPECT_EQ(gpu::openCache(other, file), std::nullopt);
    other = OWNER;
    other.uuid[15] = 1;
    EXPECT_EQ(gpu::openCache(other, file), std::nullopt);
}

class PipelineCache : public GpuTest
{
  protected:
    void SetUp() override
    {
        GpuTest::SetUp();
        folder_ = fs::temp_directory_path() / ("trichrome_cache_" + std::to_string(::getpid())) / "made";
    }
    void TearDown() override
    {
        fs::remove_all(folder_.parent_path());
        GpuTest::TearDown();
    }

    // Opens a device with the cache, makes a pipeline, closes. Returns whether the file was believed.
    bool use()
    {
        gpu::Device device = openDevice({.cacheDirectory = folder_.string()});
        const bool believed = !device.state().savedCache.empty();
        device.createComputePipeline({.label = "cached", .shader = TEST_SPIRV_DIR "/encoder_test"});
        EXPECT_TRUE(device.takeValidationMessages().empty());
        return believed;
    }
    fs::path file() const
    {
        std::vector<fs::path> found;
        for (const auto& entry : fs::directory_iterator(folder_)) found.push_back(entry.path());
        EXPECT_EQ(found.size(), 1u) << "one file, no temporary ones";
        return found.at(0);
    }

    fs::path folder_;
};

TEST_F(PipelineCache, IsWrittenAtTheEndAndBelievedNextTime)
{
    EXPECT_FALSE(use());
    EXPECT_TRUE(use());
}

TEST_F(PipelineCache, IsIgnoredWhenDamagedAndRebuilt)
{
    use();
    const Bytes good = files::read(file());
    Bytes flipped = good;
    flipped[good.size() / 2] ^= std::byte{1};
    for (const Bytes& bad : {flipped, Bytes(good.begin(), good.end() - 1), Bytes{}, Bytes(1000, std::byte{0xee})}) {
        files::writeAtomically(file(), bad);
        EXPECT_FALSE(use());
        EXPECT_TRUE(use()) << "rebuilt";
    }
}

TEST_F(PipelineCache, AFolderThatCannotBeUsedDoesNoHarm)
{
    fs::create_directories(folder_.parent_path());
    std::ofstream(folder_) << "a file where the folder should be";
    EXPECT_FALSE(use());
    EXPECT_FALSE(use());
}

} // namespace
