#pragma once
// A case as files that the program reads: NAME.gltf, NAME.exr for a sky, and NAME.json with the settings, what moves,
// and the command lines that show it.

#include <filesystem>
#include <string>
#include <vector>

#include "tests/hunt/case.h"

namespace hunt
{

// Files of this stem (a path without an extension). `finding` is a sentence for people.
void writeCase(const std::filesystem::path& stem, const Case& c, const std::string& finding);
Case readCase(const std::filesystem::path& json);

} // namespace hunt
