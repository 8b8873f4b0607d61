#include "engine/scene/choice.h"

#include <algorithm>
#include <charconv>

#include "engine/base/error.h"
#include "engine/base/shown.h"

namespace scene
{

uint32_t chooseName(const std::vector<std::string>& names, const std::string& nameOrIndex, const std::string& kind)
{
    constexpr size_t MOST = 20; // that a sentence lists
    const auto named = std::ranges::find(names, nameOrIndex);
    if (named != names.end()) return static_cast<uint32_t>(named - names.begin());

    uint32_t index = 0;
    const char* end = nameOrIndex.data() + nameOrIndex.size();
    const auto [rest, problem] = std::from_chars(nameOrIndex.data(), end, index);
    if (problem == std::errc() && rest == end && index < names.size()) return index;

    std::string list = names.empty() ? "none" : "";
    for (size_t i = 0; i < std::min(names.size(), MOST); ++i)
        list += fmt::format("{}{} \"{}\"", i == 0 ? "" : ", ", i, names[i]);
    throw Error("The scene has no {} \"{}\": it has {}{}.", kind, shown(nameOrIndex), list,
                names.size() > MOST ? " and more" : "");
}

} // namespace scene
