#include "ui/cli/output_file.h"

#include "engine/base/files.h"
#include "ui/cli/usage_error.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <unistd.h>

namespace ui
{

void requireWritable(const std::filesystem::path& file, std::initializer_list<const char*> extensions)
{
    std::string names;
    for (const char* extension : extensions) names += (names.empty() ? "" : ", ") + std::string(extension);
    if (extensions.size() > 0 && std::ranges::find(extensions, file.extension().string()) == extensions.end())
        throw UsageError("Cannot write \"{}\": its extension must be one of: {}.", file.string(), names);

    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored))
        throw Error("Cannot write \"{}\": it is a directory.", file.string());
    const std::filesystem::path directory = file.has_parent_path() ? file.parent_path() : ".";
    if (!std::filesystem::is_directory(directory, ignored))
        throw Error("Cannot write \"{}\": there is no directory \"{}\".", file.string(), directory.string());
    if (access(directory.c_str(), W_OK) != 0)
        throw Error("Cannot write \"{}\": {}.", file.string(), std::strerror(errno));
}

void writeText(const std::filesystem::path& file, const std::string& text)
{
    files::writeAtomically(file, std::as_bytes(std::span(text)));
}

} // namespace ui
