#include "engine/gpu/pipeline_cache.h"

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/base/fingerprint.h"
#include "engine/gpu/vulkan.h"

#include <cstring>

namespace gpu
{

namespace
{

constexpr std::array<char, 8> MAGIC = {'T', 'R', 'I', 'P', 'I', 'P', 'E', '\n'};
constexpr uint32_t FORMAT_VERSION = 2;
constexpr uint64_t MAX_CACHE_BYTES = uint64_t{256} << 20;

struct Header {
    std::array<char, 8> magic = MAGIC;
    uint32_t version = FORMAT_VERSION;
    CacheOwner owner;
    uint64_t size = 0;     // of the blob, bytes
    uint64_t checksum = 0; // of the blob
};
static_assert(sizeof(Header) == 56, "no padding: every byte of the file is checked");

CacheOwner ownerOf(const VkPhysicalDeviceProperties& properties)
{
    CacheOwner owner = {
        .vendor = properties.vendorID, .device = properties.deviceID, .driverVersion = properties.driverVersion};
    static_assert(sizeof(owner.uuid) == sizeof(properties.pipelineCacheUUID));
    std::memcpy(owner.uuid.data(), properties.pipelineCacheUUID, sizeof(owner.uuid));
    return owner;
}

} // namespace

std::vector<std::byte> sealCache(const CacheOwner& owner, std::span<const std::byte> blob)
{
    const Header header = {.owner = owner, .size = blob.size(), .checksum = fingerprint(blob)};
    std::vector<std::byte> file(sizeof(header) + blob.size());
    std::memcpy(file.data(), &header, sizeof(header));
    std::ranges::copy(blob, file.begin() + sizeof(header));
    return file;
}

std::optional<std::vector<std::byte>> openCache(const CacheOwner& owner, std::span<const std::byte> file)
{
    Header header;
    if (file.size() < sizeof(header)) return std::nullopt;
    std::memcpy(&header, file.data(), sizeof(header));
    const std::span blob = file.subspan(sizeof(header));
    const bool ours = header.magic == MAGIC && header.version == FORMAT_VERSION && header.owner == owner;
    if (!ours || header.size != blob.size() || header.checksum != fingerprint(blob)) return std::nullopt;
    return std::vector(blob.begin(), blob.end());
}

std::filesystem::path DeviceState::cachePath() const
{
    return std::filesystem::path(options.cacheDirectory) /
           fmt::format("pipelines-{:04x}-{:04x}.cache", properties.vendorID, properties.deviceID);
}

void DeviceState::loadPipelineCache()
{
    if (options.cacheDirectory.empty()) return;
    std::optional<std::vector<std::byte>> blob;
    try {
        blob = openCache(ownerOf(properties), files::read(cachePath(), MAX_CACHE_BYTES));
    } catch (const Error&) {
        // No cache yet, or none that can be read: begin anew.
    }
    savedCache = blob.value_or(std::vector<std::byte>{});
    const VkPipelineCacheCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                            .initialDataSize = savedCache.size(),
                                            .pInitialData = savedCache.data()};
    vkCheck(vkCreatePipelineCache(device, &info, nullptr, &pipelineCache), "vkCreatePipelineCache", "pipeline cache");
    name(VK_OBJECT_TYPE_PIPELINE_CACHE, pipelineCache, "pipeline cache");
}

void DeviceState::savePipelineCache()
{
    if (!pipelineCache) return;
    size_t size = 0;
    vkCheck(vkGetPipelineCacheData(device, pipelineCache, &size, nullptr), "vkGetPipelineCacheData", "pipeline cache");
    std::vector<std::byte> blob(size);
    vkCheck(vkGetPipelineCacheData(device, pipelineCache, &size, blob.data()), "vkGetPipelineCacheData",
            "pipeline cache");
    blob.resize(size);
    if (blob == savedCache) return;
    std::error_code failure;
    std::filesystem::create_directories(options.cacheDirectory, failure);
    if (failure) throw Error("Cannot create the cache folder \"{}\": {}.", options.cacheDirectory, failure.message());
    files::writeAtomically(cachePath(), sealCache(ownerOf(properties), blob));
    savedCache = std::move(blob);
}

void Device::savePipelineCache()
{
    state_->savePipelineCache();
}

} // namespace gpu
