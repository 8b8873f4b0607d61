#pragma once
// Whole files, read and written at once; and names of files.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace files
{

// All bytes of a regular file. Throws Error when it cannot be read, is no regular file, or is larger than `maxBytes`.
std::vector<std::byte> read(const std::filesystem::path& path, uint64_t maxBytes = uint64_t{4} << 30);

// Readers, also after a power cut, see the old file or the whole new one; where the file system can, an interrupted
// write leaves no trace (Linux: a file without a name until it is whole). A symbolic link stays one: what it leads to
// is written, there or not; and what is no regular file (/dev/null, a pipe) is written to, not replaced. Throws Error.
using Bytes = std::span<const std::byte>;
void writeAtomically(const std::filesystem::path& path, Bytes bytes);
void writeAtomically(const std::filesystem::path& path, std::span<const Bytes> pieces); // one after the other

// With all that lead to it, unless it is there. Throws Error.
void createFolder(const std::filesystem::path& path);

// Where a path leads through all symbolic links, whether there is something or not. Throws Error: in a circle.
std::filesystem::path resolved(const std::filesystem::path& path);

// There, and neither a file nor a folder: /dev/null, a pipe, a terminal.
bool isDevice(const std::filesystem::path& path);

// Whether writing to one changes the other: through whatever links, dots and names. Devices have nothing to lose.
bool areSame(const std::filesystem::path& a, const std::filesystem::path& b);

// ".exr" of "OUT.EXR": in lower case, since names of files come in any.
std::string extensionOf(const std::filesystem::path& path);

} // namespace files
