#pragma once
// What a URI of a glTF file refers to: bytes inside the URI, or a file inside the asset's folder, nothing else.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace scene::gltf
{

// "data:...;base64,..." or a relative, percent-encoded path. Throws Error: malformed, another scheme, a path that
// leaves `folder` (also through a symbolic link), not a readable regular file.
std::vector<std::byte> readUri(const std::string& uri, const std::filesystem::path& folder);

std::vector<std::byte> decodeBase64(std::string_view text); // throws Error

} // namespace scene::gltf
