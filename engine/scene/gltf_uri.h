#pragma once
// What a URI of a glTF file refers to: bytes inside the URI, or a file where the asset's files may lie, nothing else.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scene::gltf
{

// Where an asset's files may lie: below its own folder, which paths are relative to, and below `root`, if it is given.
struct Folders {
    std::filesystem::path own; // empty: the current one
    std::filesystem::path root;
};

// The file that a relative, percent-encoded path names; none for "data:...;base64,...". Throws Error: malformed,
// another scheme, a path that leaves the folders (also through a symbolic link), no such file.
std::optional<std::filesystem::path> fileOf(const std::string& uri, const Folders& folders);

// The bytes of the one or the other. Throws Error as fileOf, and when they cannot be read.
std::vector<std::byte> readUri(const std::string& uri, const Folders& folders);

std::vector<std::byte> decodeBase64(std::string_view text); // throws Error

} // namespace scene::gltf
