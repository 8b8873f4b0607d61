#pragma once
// Bytes inside of JSON.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace support
{

inline std::string base64(std::span<const std::byte> data)
{
    constexpr char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < data.size(); i += 3) {
        uint32_t bits = 0;
        for (size_t k = i; k < i + 3; ++k) bits = bits << 8 | (k < data.size() ? uint32_t(data[k]) : 0);
        for (int shift = 18; shift >= 0; shift -= 6) text += DIGITS[bits >> shift & 63];
    }
    for (size_t k = data.size(); k % 3 != 0; ++k) text[text.size() - (k - data.size()) - 1] = '=';
    return text;
}

} // namespace support
