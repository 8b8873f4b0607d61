#pragma once
// Tells when shader sources have changed, for hot reload.

#include <cstdint>
#include <filesystem>
#include <map>
#include <utility>

namespace gpu
{

class ShaderWatcher
{
  public:
    // Watches .comp, .glsl and .h files under `directory`, at any depth. Throws Error when it cannot be read.
    explicit ShaderWatcher(std::filesystem::path directory);

    // Whether any file was added, removed or changed since the last call (or construction). Looks at the disk each
    // time.
    bool changed();

  private:
    using Stamp = std::pair<std::filesystem::file_time_type, uintmax_t>; // time and size
    std::map<std::filesystem::path, Stamp> look() const;

    std::filesystem::path directory_;
    std::map<std::filesystem::path, Stamp> seen_;
};

} // namespace gpu
