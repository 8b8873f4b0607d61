#pragma once
// Picture files in memory, to and from samples. The bytes are untrusted: no allocation beyond what they can justify.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/image/image.h"

namespace image
{

constexpr uint64_t MAX_PIXELS = uint64_t{1} << 28;

// RGBA samples of uint8_t or uint16_t, row 0 at the top; full scale is opaque white.
template <class Sample>
struct Raster {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<Sample> rgba;
};

// Throws Error: more pixels than we read, or, as the decoder that asks finds, than so many bytes can hold.
void requirePlausible(const std::string& what, uint64_t width, uint64_t height, bool fits, size_t bytes);

bool isPng(std::span<const std::byte> bytes);
bool isJpeg(std::span<const std::byte> bytes);

uint32_t pngBitDepth(std::span<const std::byte> bytes); // of a sample in the file; 0: too short to say

// `metadata`, when given, receives the text chunks. Throws Error: "<what> is ..." with the decoder's reason.
template <class Sample>
Raster<Sample> decodePng(std::span<const std::byte> bytes, const std::string& what, Metadata* metadata = nullptr);

Raster<uint8_t> decodeJpeg(std::span<const std::byte> bytes, const std::string& what);

// OpenEXR: R, G and B, or Y alone, of any channel type, of `layer` or, where that is empty, of none. `transparent`,
// when given, says whether A is anywhere not 1.
bool isExr(std::span<const std::byte> bytes);
Image decodeExr(std::span<const std::byte> bytes, const std::string& what, Metadata* metadata = nullptr,
                bool* transparent = nullptr, const std::string& layer = "");
std::vector<std::byte> encodeExr(const Image& image, const Metadata& metadata, std::span<const Layer> layers = {});

// Radiance RGBE.
bool isHdr(std::span<const std::byte> bytes);
Image decodeHdr(std::span<const std::byte> bytes, const std::string& what);

// 8-bit RGB, `rgb` holds 3 * width * height samples.
std::vector<std::byte> encodePng(uint32_t width, uint32_t height, std::span<const uint8_t> rgb,
                                 const Metadata& metadata);

} // namespace image
