#pragma once
// Files that commands write: refused before the work rather than after it.

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

namespace ui
{

// Throws UsageError when the extension, in any case, is none of `extensions` (empty: any), Error when the directory
// cannot be written to.
void requireWritable(const std::filesystem::path& file, std::initializer_list<const char*> extensions = {});

struct NamedFile {
    std::string option; // that names it
    std::filesystem::path file;
};

// The files that a command line names, so that none is written over another. Each function throws UsageError where an
// output is another output or an input (files::areSame). An empty name is no file; what is not there cannot be lost, so
// it is no input.
class NamedFiles
{
  public:
    void reads(const std::string& option, const std::filesystem::path& file);
    void writes(const std::string& option, const std::filesystem::path& file);
    // One of the many files that an option writes; not remembered.
    void writesAlso(const std::string& option, const std::filesystem::path& file) const;

  private:
    std::vector<NamedFile> inputs_, outputs_;
};

// Whole or not at all. Throws Error.
void writeText(const std::filesystem::path& file, const std::string& text);

} // namespace ui
