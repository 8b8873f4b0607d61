#include "engine/base/shown.h"

#include <algorithm>

std::string shown(const std::string& text, size_t maxLength)
{
    size_t length = std::min(text.size(), maxLength);
    while (length < text.size() && length > 0 && (text[length] & 0xc0) == 0x80) --length; // whole UTF-8 characters
    std::string result = text.substr(0, length);
    for (char& c : result) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    }
    return length < text.size() ? result + "..." : result;
}
