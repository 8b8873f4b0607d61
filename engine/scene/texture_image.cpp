#include "engine/scene/texture_image.h"

#include <algorithm>
#include <utility>

#include "engine/base/error.h"
#include "engine/image/codecs.h"

namespace scene
{

namespace
{

// k of 255 is 257 k of 65535.
bool fitsEightBits(const std::vector<uint16_t>& samples)
{
    return std::ranges::all_of(samples, [](uint16_t sample) { return sample % 257 == 0; });
}

Image decode(std::span<const std::byte> bytes, const std::string& what)
{
    const auto from = [](auto&& raster) { return Image{.width = raster.width, .height = raster.height}; };
    if (image::isPng(bytes) && image::pngBitDepth(bytes) == 16) {
        image::Raster<uint16_t> raster = image::decodePng<uint16_t>(bytes, what);
        Image image = from(raster);
        if (fitsEightBits(raster.rgba))
            for (const uint16_t sample : raster.rgba) image.rgba.push_back(uint8_t(sample / 257));
        else
            image.deep = std::move(raster.rgba);
        return image;
    }
    if (!image::isPng(bytes) && !image::isJpeg(bytes))
        throw Error("{} ({} bytes) is neither PNG nor JPEG.", what, bytes.size());
    auto raster = image::isPng(bytes) ? image::decodePng<uint8_t>(bytes, what) : image::decodeJpeg(bytes, what);
    Image image = from(raster);
    image.rgba = std::move(raster.rgba);
    return image;
}

} // namespace

Image decodeTexture(std::span<const std::byte> bytes, const std::string& name)
{
    Image image = decode(bytes, fmt::format("Image \"{}\"", name));
    image.name = name;
    if (std::max(image.width, image.height) > MAX_TEXTURE_SIDE)
        throw Error("Image \"{}\" is {} x {} pixels, but a texture may have {} along a side.", name, image.width,
                    image.height, MAX_TEXTURE_SIDE);
    return image;
}

} // namespace scene
