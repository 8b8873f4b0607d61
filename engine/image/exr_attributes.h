#pragma once
// What OpenEXR believes of a file's header, checked before it does.

#include <cstddef>
#include <span>
#include <string>

namespace image
{

// Throws Error, naming the attribute, where one of an EXR's header is not as long as it says. OpenEXR takes memory for
// what a length claims, up to 2 GB; and it reads most types by their own size, so a false length hides the next one.
void checkAttributes(std::span<const std::byte> bytes, const std::string& what);

} // namespace image
