#pragma once
// A 64-bit fingerprint of bytes: finds damage and tells contents apart. No protection against forgery.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

// Chained: fingerprint(b, fingerprint(a)) is that of a, then b, and differs from that of the two as one.
inline uint64_t fingerprint(std::span<const std::byte> bytes, uint64_t before = 0)
{
    constexpr uint64_t ODD = 0x9e3779b97f4a7c15; // 2^64 over the golden ratio
    // A bijection of the state for each word and of the word for each state: no change of one word goes unseen.
    const auto step = [](uint64_t state, uint64_t word) { return std::rotl((state ^ word) * ODD, 27); };
    uint64_t state = step(before, bytes.size());
    for (; !bytes.empty(); bytes = bytes.subspan(std::min<size_t>(bytes.size(), sizeof(uint64_t)))) {
        uint64_t word = 0;
        std::memcpy(&word, bytes.data(), std::min<size_t>(bytes.size(), sizeof(word)));
        state = step(state, word);
    }
    return step(state ^ (state >> 32), 0);
}

inline uint64_t fingerprint(std::string_view text, uint64_t before = 0)
{
    return fingerprint(std::as_bytes(std::span(text)), before);
}
