// Radiance RGBE through stb_image, of which this file alone holds a copy (compiled from its header).

#include "engine/image/codecs.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <string_view>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#include <stb/stb_image.h>

#include "engine/base/error.h"

namespace image
{

namespace
{

// A row of the run-length form: two bytes for up to 127 values, four values a pixel.
constexpr uint64_t MAX_PIXELS_PER_BYTE = 16;

struct Stream {
    std::span<const std::byte> rest;
    bool ranOut = false; // stb_image says nothing of it
};

const stbi_io_callbacks CALLBACKS = {
    .read =
        [](void* user, char* to, int size) {
            auto& stream = *static_cast<Stream*>(user);
            const size_t count = std::min(static_cast<size_t>(size), stream.rest.size());
            if (count == 0) {
                // Past the end stb_image would read zeros, and wait for ever for a run that is not empty. Newlines
                // end its loops: of the header, and of runs.
                stream.ranOut = true;
                std::memset(to, '\n', static_cast<size_t>(size));
                return size;
            }
            std::memcpy(to, stream.rest.data(), count);
            stream.rest = stream.rest.subspan(count);
            return static_cast<int>(count);
        },
    .skip =
        [](void* user, int count) {
            auto& stream = *static_cast<Stream*>(user);
            stream.rest = stream.rest.subspan(std::min(static_cast<size_t>(count), stream.rest.size()));
        },
    .eof = [](void* user) { return static_cast<int>(static_cast<Stream*>(user)->rest.empty()); },
};

} // namespace

bool isHdr(std::span<const std::byte> bytes)
{
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return text.starts_with("#?RADIANCE\n") || text.starts_with("#?RGBE\n");
}

Image decodeHdr(std::span<const std::byte> bytes, const std::string& what)
{
    const auto malformed = [&] { return Error("{} is no valid Radiance HDR: {}.", what, stbi_failure_reason()); };
    int width = 0, height = 0, channels = 0;
    Stream header{bytes};
    if (!stbi_info_from_callbacks(&CALLBACKS, &header, &width, &height, &channels)) throw malformed();
    if (width <= 0 || height <= 0) throw Error("{} is {} x {} pixels.", what, width, height);
    const uint64_t pixels = static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
    requirePlausible(what, uint64_t(width), uint64_t(height), pixels <= MAX_PIXELS_PER_BYTE * bytes.size(),
                     bytes.size());

    Stream stream{bytes};
    const std::unique_ptr<float, decltype(&stbi_image_free)> data(
        stbi_loadf_from_callbacks(&CALLBACKS, &stream, &width, &height, &channels, 3), stbi_image_free);
    if (stream.ranOut) throw Error("{} is cut short.", what);
    if (!data) throw malformed();
    Image image{static_cast<uint32_t>(width), static_cast<uint32_t>(height), {}};
    image.pixels.resize(pixels);
    std::memcpy(image.pixels.data(), data.get(), pixels * sizeof(glm::vec3));
    return image;
}

} // namespace image
