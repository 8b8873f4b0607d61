#pragma once
// Files that commands write: refused before the work rather than after it.

#include <filesystem>
#include <initializer_list>
#include <string>

namespace ui
{

// Throws UsageError when the extension is none of `extensions` (empty: any), Error when the directory cannot be
// written to.
void requireWritable(const std::filesystem::path& file, std::initializer_list<const char*> extensions = {});

// Whole or not at all. Throws Error.
void writeText(const std::filesystem::path& file, const std::string& text);

} // namespace ui
