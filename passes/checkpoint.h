#pragma once
// Unfinished renders as files: whose they are and where they stand. For `render` and whatever else renders for hours.
//
// The file: header (magic, format version, sizes, fingerprint), JSON, the bytes of the buffers.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "passes/renderer.h"

namespace passes
{

// Name and value of everything that must be equal for a render to go on, most telling first.
using Identity = std::vector<std::pair<std::string, std::string>>;

struct Checkpoint {
    Identity identity;
    double seconds = 0; // rendered so far
    RendererState state;
};

// Whole or not at all. Throws Error.
void write(const std::filesystem::path& file, const Checkpoint& checkpoint);

// Throws Error: not readable, no checkpoint, damaged, cut short, of another format version. Nothing is allocated beyond
// the size of the file.
Checkpoint readCheckpoint(const std::filesystem::path& file);

// The same of a file's bytes; `file` is for messages.
Checkpoint parseCheckpoint(std::span<const std::byte> bytes, const std::string& file);

// Throws Error naming the first difference between the checkpoint's identity and the present one.
void requireSame(const Checkpoint& checkpoint, const Identity& now, const std::string& file);

} // namespace passes
