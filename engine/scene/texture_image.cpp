#include "engine/scene/texture_image.h"

#include <algorithm>
#include <utility>

#include "engine/base/error.h"
#include "engine/image/codecs.h"

namespace scene
{

Image decodeTexture(std::span<const std::byte> bytes, const std::string& name)
{
    const auto decode = [&]() -> image::Raster<uint8_t> {
        const std::string what = fmt::format("Image \"{}\"", name);
        if (image::isPng(bytes)) return image::decodePng<uint8_t>(bytes, what);
        if (image::isJpeg(bytes)) return image::decodeJpeg(bytes, what);
        throw Error("{} ({} bytes) is neither PNG nor JPEG.", what, bytes.size());
    };
    image::Raster<uint8_t> raster = decode();
    if (std::max(raster.width, raster.height) > MAX_TEXTURE_SIDE)
        throw Error("Image \"{}\" is {} x {} pixels, but a texture may have {} along a side.", name, raster.width,
                    raster.height, MAX_TEXTURE_SIDE);
    return {.name = name, .width = raster.width, .height = raster.height, .rgba = std::move(raster.rgba)};
}

} // namespace scene
