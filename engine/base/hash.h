#pragma once
// FNV-1a, 64 bits: names for equal contents, no protection against anybody.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

constexpr uint64_t FNV_START = 14695981039346656037u;
constexpr uint64_t FNV_PRIME = 1099511628211u;

inline uint64_t fnv1a(std::span<const std::byte> bytes, uint64_t state = FNV_START)
{
    for (const std::byte byte : bytes) state = (state ^ uint64_t(byte)) * FNV_PRIME;
    return state;
}

// Of a text and a zero byte after it, so that texts in a row are set apart.
inline uint64_t fnv1a(std::string_view text, uint64_t state = FNV_START)
{
    return fnv1a(std::as_bytes(std::span(text)), state) * FNV_PRIME;
}
