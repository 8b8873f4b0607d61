#pragma once
// The file format of the pipeline cache. Drivers trust the blob they are handed, so we hand back only what is whole and
// was written by the very same driver; anything else counts as absent.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gpu
{

// Whose cache it is.
struct CacheOwner {
    uint32_t vendor = 0;
    uint32_t device = 0;
    uint32_t driverVersion = 0;
    std::array<uint8_t, 16> uuid = {}; // VkPhysicalDeviceProperties::pipelineCacheUUID
    bool operator==(const CacheOwner&) const = default;
};

// The file's bytes: a header (magic, format version, owner, size, checksum) and the driver's blob.
std::vector<std::byte> sealCache(const CacheOwner& owner, std::span<const std::byte> blob);

// The blob; nothing when the file is damaged, cut short, of another format version or another owner's.
std::optional<std::vector<std::byte>> openCache(const CacheOwner& owner, std::span<const std::byte> file);

} // namespace gpu
