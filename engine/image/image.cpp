#include "engine/image/image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/base/shown.h"
#include "engine/image/codecs.h"

namespace image
{

namespace
{

// Tells read() that a PNG is tonemapped by us.
const Metadata::value_type TONEMAPPED = {"tonemapping", "Reinhard c/(c+1), sRGB"};

// IEC 61966-2-1.
double encodeSrgb(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

uint8_t tonemap(float value)
{
    const double mapped = value > 0 ? 1 - 1 / (1 + double{value}) : 0; // infinity is white
    return static_cast<uint8_t>(std::lround(255 * encodeSrgb(mapped)));
}

// Full scale stands for all brighter values: it reads as the darkest of them, half a step of 8 bits below.
double undoReinhard(double encoded)
{
    const double mapped = linearFromSrgb(std::min(encoded, 254.5 / 255));
    return mapped / (1 - mapped);
}

template <class Sample>
Image linearFrom(const Raster<Sample>& raster, bool tonemapped)
{
    std::vector<float> table(size_t{std::numeric_limits<Sample>::max()} + 1);
    for (size_t i = 0; i < table.size(); ++i) {
        const double encoded = static_cast<double>(i) / std::numeric_limits<Sample>::max();
        table[i] = static_cast<float>(tonemapped ? undoReinhard(encoded) : linearFromSrgb(encoded));
    }
    Image image{raster.width, raster.height, {}};
    image.pixels.reserve(raster.rgba.size() / 4);
    for (size_t i = 0; i < raster.rgba.size(); i += 4)
        image.pixels.emplace_back(table[raster.rgba[i]], table[raster.rgba[i + 1]], table[raster.rgba[i + 2]]);
    return image;
}

template <class Sample>
bool isTransparent(const Raster<Sample>& raster)
{
    for (size_t i = 3; i < raster.rgba.size(); i += 4)
        if (raster.rgba[i] != std::numeric_limits<Sample>::max()) return true;
    return false;
}

} // namespace

void requirePlausible(const std::string& what, uint64_t width, uint64_t height, bool fits, size_t bytes)
{
    if (width * height > MAX_PIXELS)
        throw Error("{} is {} x {} pixels, more than the limit of {}.", what, width, height, MAX_PIXELS);
    if (!fits) throw Error("{} claims {} x {} pixels, more than its {} bytes can hold.", what, width, height, bytes);
}

double linearFromSrgb(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

std::vector<std::byte> tonemappedPng(const Image& image, Metadata metadata)
{
    std::vector<uint8_t> rgb;
    rgb.reserve(3 * image.pixels.size());
    for (const glm::vec3& pixel : image.pixels)
        for (int c = 0; c < 3; ++c) rgb.push_back(tonemap(pixel[c]));
    metadata.push_back(TONEMAPPED);
    return encodePng(image.width, image.height, rgb, metadata);
}

void requireWritable(const std::filesystem::path& path)
{
    const std::string extension = files::extensionOf(path);
    if (extension != ".exr" && extension != ".png")
        throw Error("Cannot write \"{}\": the name must end in .exr or .png.", path.string());
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored))
        throw Error("Cannot write \"{}\": there is no folder \"{}\".", path.string(), folder.string());
    if (std::filesystem::is_directory(path, ignored))
        throw Error("Cannot write \"{}\": it is a folder.", path.string());
}

void write(const std::filesystem::path& path, const Image& image, const Metadata& metadata,
           const std::vector<Layer>& layers)
{
    CHECK_EQ(image.pixels.size(), size_t{image.width} * image.height);
    requireWritable(path);
    const bool exr = files::extensionOf(path) == ".exr";
    CHECK(exr || layers.empty());
    files::writeAtomically(path, exr ? encodeExr(image, metadata, layers) : tonemappedPng(image, metadata));
}

Loaded read(const std::filesystem::path& path, const std::string& layer)
{
    const std::vector<std::byte> bytes = files::read(path);
    const std::string what = fmt::format("Picture \"{}\"", path.string());
    Loaded loaded;
    bool transparent = false;
    if (isExr(bytes)) {
        loaded.image = decodeExr(bytes, what, &loaded.metadata, &transparent, layer);
    } else if (!layer.empty()) {
        throw Error("{} is no EXR, so it has no layer \"{}\".", what, shown(layer));
    } else if (isHdr(bytes)) {
        loaded.image = decodeHdr(bytes, what);
    } else if (isPng(bytes)) {
        const auto raster = decodePng<uint16_t>(bytes, what, &loaded.metadata);
        const auto& metadata = loaded.metadata;
        transparent = isTransparent(raster);
        loaded.image = linearFrom(raster, std::find(metadata.begin(), metadata.end(), TONEMAPPED) != metadata.end());
    } else if (isJpeg(bytes)) {
        loaded.image = linearFrom(decodeJpeg(bytes, what), false);
    } else {
        throw Error("{} ({} bytes) is neither EXR, HDR, PNG nor JPEG.", what, bytes.size());
    }
    if (transparent)
        loaded.warnings.push_back(
            fmt::format("{} has an alpha channel that is not 1 everywhere: it is ignored.", what));
    return loaded;
}

} // namespace image
