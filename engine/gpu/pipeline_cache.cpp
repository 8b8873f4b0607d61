#include "engine/gpu/pipeline_cache.h"

#include "engine/base/fingerprint.h"

#include <algorithm>
#include <cstring>

namespace gpu
{

namespace
{

constexpr std::array<char, 8> MAGIC = {'T', 'R', 'I', 'P', 'I', 'P', 'E', '\n'};
constexpr uint32_t FORMAT_VERSION = 2;

struct Header {
    std::array<char, 8> magic = MAGIC;
    uint32_t version = FORMAT_VERSION;
    CacheOwner owner;
    uint64_t size = 0;     // of the blob, bytes
    uint64_t checksum = 0; // of the blob
};
static_assert(sizeof(Header) == 56, "no padding: every byte of the file is checked");

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

} // namespace gpu
