#pragma once
// Which of several named objects of a scene a person means.

#include <cstdint>
#include <string>
#include <vector>

namespace scene
{

// The first of that name, else that of that index. Throws Error that lists them; `kind` is what they are: "camera".
uint32_t chooseName(const std::vector<std::string>& names, const std::string& nameOrIndex, const std::string& kind);

} // namespace scene
