#include "engine/gpu/shader_watcher.h"

#include "engine/base/error.h"

namespace gpu
{

namespace fs = std::filesystem;

ShaderWatcher::ShaderWatcher(fs::path directory) : directory_(std::move(directory))
{
    if (!fs::is_directory(directory_)) throw Error("There is no shader folder \"{}\".", directory_.string());
    seen_ = look();
}

bool ShaderWatcher::changed()
{
    std::map<fs::path, Stamp> now = look();
    if (now == seen_) return false;
    seen_ = std::move(now);
    return true;
}

std::map<fs::path, ShaderWatcher::Stamp> ShaderWatcher::look() const
{
    std::map<fs::path, Stamp> found;
    std::error_code vanished; // editors replace files: one that goes while we look has changed, which is what we report
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(directory_, vanished)) {
        const fs::path extension = entry.path().extension();
        if (extension != ".comp" && extension != ".glsl" && extension != ".h") continue;
        found[entry.path()] = {entry.last_write_time(vanished), entry.file_size(vanished)};
    }
    return found;
}

} // namespace gpu
