#pragma once
// Lists that Vulkan gives in two calls: how many there are, and which. For whoever talks to it, in engine/gpu and the
// window.

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include <vulkan/vulkan.h>

namespace gpu
{

// Of a function that takes `arguments`, then the count and the elements. Empty where it fails.
template <class Element, class Function, class... Arguments>
std::vector<Element> listOf(Function function, Arguments... arguments)
{
    uint32_t count = 0;
    function(arguments..., &count, nullptr);
    std::vector<Element> list(count);
    function(arguments..., &count, list.data());
    list.resize(count);
    return list;
}

inline bool holds(const std::vector<VkExtensionProperties>& extensions, std::string_view name)
{
    return std::ranges::any_of(extensions, [&](const VkExtensionProperties& e) { return e.extensionName == name; });
}

} // namespace gpu
