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

// Readers, also after a power cut, see the old file or the whole new one; where the file system can, an interrupted
// write leaves no trace (Linux: a file without a name until it is whole). Throws Error.
using Bytes = std::span<const std::byte>;
void writeAtomically(const std::filesystem::path& path, Bytes bytes);
void writeAtomically(const std::filesystem::path& path, std::span<const Bytes> pieces); // one after the other

} // namespace files
