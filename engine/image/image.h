#pragma once
// Float RGB pictures and their files.

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

namespace image {

struct Image {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<glm::vec3> pixels; // linear RGB, row 0 at the top

    glm::vec3& at(uint32_t x, uint32_t y) { return pixels[size_t{y} * width + x]; }
    const glm::vec3& at(uint32_t x, uint32_t y) const { return pixels[size_t{y} * width + x]; }
};

// Key and value pairs, in order: EXR string attributes, PNG tEXt chunks.
using Metadata = std::vector<std::pair<std::string, std::string>>;

// EXR: float32 R, G, B, ZIP. PNG: 8 bit, Reinhard c/(c+1) per channel then sRGB. By extension; written whole or not at all.
// Throws Error: other extension, cannot write.
void write(const std::filesystem::path& path, const Image& image, const Metadata& metadata);

struct Loaded {
    Image image;
    Metadata metadata;
};
// EXR (any channel type, R G B needed) or PNG (8/16 bit, decoded sRGB and, as written by us, un-tonemapped when the metadata
// says so). Throws Error: missing, malformed, larger than 2^28 pixels or than the file could hold.
Loaded read(const std::filesystem::path& path);

} // namespace image
