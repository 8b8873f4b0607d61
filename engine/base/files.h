#pragma once
// Whole files, read and written at once.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace files
{

// All bytes of a regular file. Throws Error when it cannot be read, is no regular file, or is larger than `maxBytes`.
std::vector<std::byte> read(const std::filesystem::path& path, uint64_t maxBytes = uint64_t{4} << 30);

// Writes a temporary neighbour and renames it: readers see the old file or the whole new one. Throws Error.
void writeAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes);

} // namespace files
