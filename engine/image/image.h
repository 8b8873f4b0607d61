#pragma once
// Float RGB pictures and their files.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

namespace image
{

struct Image {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<glm::vec3> pixels; // linear RGB, row 0 at the top

    glm::vec3& at(uint32_t x, uint32_t y) { return pixels[size_t{y} * width + x]; }
    const glm::vec3& at(uint32_t x, uint32_t y) const { return pixels[size_t{y} * width + x]; }
};

// Key and value pairs: EXR string attributes (read back in the keys' order), PNG text chunks.
using Metadata = std::vector<std::pair<std::string, std::string>>;

// A further picture of an EXR file, of the same size. Its channels there are "name.R", "name.G", ...
struct Layer {
    std::string name;
    std::string channels; // a letter each, at most three
    Image picture;
};

// EXR: float32 R, G, B, ZIP, and the layers. PNG: 8 bit, Reinhard c/(c+1) per channel then sRGB; no layers. By
// extension; written whole or not at all. Throws Error: other extension, cannot write.
void write(const std::filesystem::path& path, const Image& image, const Metadata& metadata,
           const std::vector<Layer>& layers = {});

// The bytes that write() puts into a PNG file.
std::vector<std::byte> tonemappedPng(const Image& image, Metadata metadata);

double linearFromSrgb(double encoded); // IEC 61966-2-1, both 0 to 1

// Throws the Error that write() would for this name: to be asked before hours of rendering.
void requireWritable(const std::filesystem::path& path);

struct Loaded {
    Image image;
    Metadata metadata;
    std::vector<std::string> warnings; // sentences for the person: what of the file is ignored
};
// EXR (any channel type; R G B, or Y alone), Radiance HDR, PNG (8/16 bit, decoded sRGB and, when our metadata says so,
// un-tonemapped) or JPEG, told apart by their first bytes. Pixels as the file has them, non-finite ones too. Alpha is
// ignored, with a warning where it is not 1. `layer`: of an EXR; empty: the channels without a layer's name.
// Throws Error: missing, malformed, larger than 2^28 pixels or than the file could hold, without such a layer.
Loaded read(const std::filesystem::path& path, const std::string& layer = "");

} // namespace image
