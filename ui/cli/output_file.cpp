#include "ui/cli/output_file.h"

#include "engine/base/files.h"
#include "ui/cli/usage_error.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <unistd.h>

#include <fmt/ranges.h>

namespace ui
{

namespace
{

void requireApart(const NamedFile& output, const NamedFile& input)
{
    if (files::areSame(output.file, input.file))
        throw UsageError("{} would write over \"{}\", which {} reads: name another file.", output.option,
                         input.file.string(), input.option);
}

void requireTwo(const NamedFile& output, const std::string& option, const std::filesystem::path& file)
{
    if (files::areSame(output.file, file))
        throw UsageError("{} and {} would both write the file \"{}\": name two.", output.option, option, file.string());
}

} // namespace

void requireWritable(const std::filesystem::path& file, std::initializer_list<const char*> extensions)
{
    if (extensions.size() > 0 && std::ranges::find(extensions, files::extensionOf(file)) == extensions.end())
        throw UsageError("Cannot write \"{}\": its extension must be one of: {}.", file.string(),
                         fmt::join(extensions, ", "));

    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored))
        throw Error("Cannot write \"{}\": it is a directory.", file.string());
    const std::filesystem::path directory = files::resolved(file).parent_path();
    const bool device = files::isDevice(file); // written to as it is; a file is made in its directory
    if (!device && !std::filesystem::is_directory(directory, ignored))
        throw Error("Cannot write \"{}\": there is no directory \"{}\".", file.string(), directory.string());
    if (access(device ? file.c_str() : directory.c_str(), W_OK) != 0)
        throw Error("Cannot write \"{}\": {}.", file.string(), std::strerror(errno));
}

void NamedFiles::reads(const std::string& option, const std::filesystem::path& file)
{
    std::error_code ignored;
    if (file.empty() || !std::filesystem::exists(file, ignored)) return;
    inputs_.push_back({option, file});
    for (const NamedFile& output : outputs_) requireApart(output, inputs_.back());
}

void NamedFiles::writes(const std::string& option, const std::filesystem::path& file)
{
    if (file.empty()) return;
    for (const NamedFile& output : outputs_) requireTwo(output, option, file);
    outputs_.push_back({option, file});
    for (const NamedFile& input : inputs_) requireApart(outputs_.back(), input);
}

void NamedFiles::writesAlso(const std::string& option, const std::filesystem::path& file) const
{
    for (const NamedFile& output : outputs_)
        if (output.option != option) requireTwo(output, option, file);
    for (const NamedFile& input : inputs_) requireApart({option, file}, input);
}

void writeText(const std::filesystem::path& file, const std::string& text)
{
    files::writeAtomically(file, std::as_bytes(std::span(text)));
}

} // namespace ui
