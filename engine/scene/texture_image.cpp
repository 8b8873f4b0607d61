#include "engine/scene/texture_image.h"

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
    return {.name = name, .width = raster.width, .height = raster.height, .rgba = std::move(raster.rgba)};
}

} // namespace scene
