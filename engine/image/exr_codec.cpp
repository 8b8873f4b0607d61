// EXR through OpenEXR, which reports by exceptions of its own.

#include "engine/image/codecs.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <set>
#include <string_view>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/base/shown.h"
#include "engine/image/exr_attributes.h"

namespace image
{

namespace
{

constexpr int MAX_SIDE = 1 << 16;
constexpr int MAX_TILE = 1 << 12; // per side
constexpr int ROWS_AT_ONCE = 256; // memory grows with what was decoded, not with what the header claims
constexpr int64_t MAX_BLOCK_BYTES = int64_t{1} << 29; // OpenEXR holds a row of tiles or a block of scan lines whole

// The most bytes of pixels in a byte of file. A picture of one value comes to 59049 by DWA and to 1204 by the others;
// deflate alone cannot exceed 1032, and PXR24 drops one byte of four before it.
constexpr int64_t MAX_RATIO_DWA = int64_t{1} << 16;
constexpr int64_t MAX_RATIO = int64_t{1} << 11;

// OpenEXR gives these names a type or a meaning of its own; ours get a prefix in the file.
constexpr std::array RESERVED = {"name", "type", "version", "chunkCount", "view", "tiles", "maxSamplesPerPixel"};
constexpr std::string_view PREFIX = "trichrome.";

class MemoryInput : public Imf::IStream
{
  public:
    explicit MemoryInput(std::span<const std::byte> bytes) : IStream("memory"), bytes_(bytes) {}

    bool read(char to[], int count) override
    {
        const auto size = static_cast<size_t>(count);
        if (position_ > bytes_.size() || size > bytes_.size() - position_) throw Iex::InputExc("it is cut short");
        std::memcpy(to, bytes_.data() + position_, size);
        position_ += size;
        return position_ < bytes_.size();
    }
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t position) override { position_ = position; }

  private:
    std::span<const std::byte> bytes_;
    uint64_t position_ = 0;
};

class MemoryOutput : public Imf::OStream
{
  public:
    MemoryOutput() : OStream("memory") {}

    void write(const char from[], int count) override
    {
        const auto size = static_cast<size_t>(count);
        if (position_ + size > bytes.size()) bytes.resize(position_ + size);
        std::memcpy(bytes.data() + position_, from, size);
        position_ += size;
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t position) override { position_ = position; }

    std::vector<std::byte> bytes;

  private:
    uint64_t position_ = 0;
};

// Where one channel of the pixel (x, y) of the data window lies, for OpenEXR: a value every `stride` bytes from
// `first`, which is that of the window's leftmost pixel in `firstRow`.
Imf::Slice sliceOf(const float* first, size_t stride, const Imath::Box2i& window, int firstRow)
{
    const int64_t width = int64_t{window.max.x} - window.min.x + 1;
    const int64_t origin = firstRow * width + window.min.x;
    auto* values = const_cast<float*>(first); // a slice serves both directions: what is written to a file is only read
    return {Imf::FLOAT, reinterpret_cast<char*>(values) - static_cast<int64_t>(stride) * origin, stride,
            static_cast<size_t>(width) * stride};
}

// Throws where the header claims more than a file of so many bytes can hold. To be asked before OpenEXR takes memory
// for the pixels: it goes by the header alone.
void checkClaim(const Imf::Header& header, size_t bytes, const std::string& what)
{
    const Imath::Box2i& window = header.dataWindow();
    const int64_t width = int64_t{window.max.x} - window.min.x + 1;
    const int64_t height = int64_t{window.max.y} - window.min.y + 1;
    int64_t bytesPerPixel = 0; // over all channels, whether we read them or not
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
        bytesPerPixel += channel.channel().type == Imf::HALF ? 2 : 4;
    const Imf::Compression compression = header.compression();
    const bool dwa = compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
    const int64_t claimed = width * height * bytesPerPixel;
    requirePlausible(what, static_cast<uint64_t>(width), static_cast<uint64_t>(height),
                     claimed <= static_cast<int64_t>(bytes) * (dwa ? MAX_RATIO_DWA : MAX_RATIO), bytes);

    const int64_t rows = header.hasTileDescription() ? header.tileDescription().ySize : ROWS_AT_ONCE;
    if (width * std::min(rows, height) * bytesPerPixel > MAX_BLOCK_BYTES)
        throw Error("{} has blocks of {} x {} pixels of {} bytes, more than the limit of {} bytes.", what, width,
                    std::min(rows, height), bytesPerPixel, MAX_BLOCK_BYTES);
}

// Of the channels whose names begin with `prefix`: the layer's and a dot, or nothing.
Image readPixels(Imf::InputPart& file, const std::string& prefix, bool gray, bool* transparent)
{
    const Imath::Box2i& window = file.header().dataWindow();
    const auto width = static_cast<uint32_t>(window.max.x - window.min.x + 1);
    Image image{width, 0, {}};
    const bool hasAlpha = transparent && file.header().channels().findChannel(prefix + "A");
    const auto rowsAtOnce = static_cast<size_t>(std::min(ROWS_AT_ONCE, window.max.y - window.min.y + 1));
    std::vector<float> alphas(hasAlpha ? width * rowsAtOnce : 0);
    for (int y = window.min.y; y <= window.max.y; y += ROWS_AT_ONCE) {
        const int last = std::min(y + ROWS_AT_ONCE - 1, window.max.y);
        image.height += static_cast<uint32_t>(last - y + 1);
        image.pixels.resize(size_t{width} * image.height);
        glm::vec3* rows = &image.pixels[size_t{width} * static_cast<size_t>(y - window.min.y)];
        Imf::FrameBuffer buffer;
        if (gray)
            buffer.insert(prefix + "Y", sliceOf(&rows->x, sizeof(glm::vec3), window, y));
        else
            for (int c = 0; c < 3; ++c)
                buffer.insert(prefix + "RGB"[c], sliceOf(&rows->x + c, sizeof(glm::vec3), window, y));
        if (hasAlpha) buffer.insert(prefix + "A", sliceOf(alphas.data(), sizeof(float), window, y));
        file.setFrameBuffer(buffer);
        file.readPixels(y, last);
        const auto end = alphas.begin() + (hasAlpha ? ptrdiff_t{width} * (last - y + 1) : 0);
        if (std::any_of(alphas.begin(), end, [](float alpha) { return alpha != 1; })) *transparent = true;
    }
    if (gray) {
        for (glm::vec3& pixel : image.pixels) pixel = glm::vec3(pixel.x);
    }
    return image;
}

bool isReserved(const std::string& key)
{
    return std::find(RESERVED.begin(), RESERVED.end(), key) != RESERVED.end();
}

Metadata readMetadata(const Imf::Header& header)
{
    Metadata metadata;
    for (auto entry = header.begin(); entry != header.end(); ++entry) {
        const auto* text = dynamic_cast<const Imf::StringAttribute*>(&entry.attribute());
        std::string key = entry.name();
        if (!text || isReserved(key)) continue;
        if (key.starts_with(PREFIX) && isReserved(key.substr(PREFIX.size()))) key = key.substr(PREFIX.size());
        metadata.emplace_back(key, text->value());
    }
    return metadata;
}

// For the end of a sentence about a picture that is not there.
std::string listOfLayers(const Imf::ChannelList& channels)
{
    constexpr size_t MOST = 16;
    std::set<std::string> names;
    channels.layers(names);
    std::string list;
    size_t count = 0;
    for (const std::string& name : names)
        if (count++ < MOST) list += (count == 1 ? "; its layers are " : ", ") + fmt::format("\"{}\"", shown(name));
    return list + (names.size() > MOST ? " and others" : "");
}

Image decode(std::span<const std::byte> bytes, const std::string& what, Metadata* metadata, bool* transparent,
             const std::string& layer)
{
    checkAttributes(bytes, what);
    MemoryInput input(bytes);
    Imf::Header::setMaxImageSize(MAX_SIDE, MAX_SIDE);
    Imf::Header::setMaxTileSize(MAX_TILE, MAX_TILE);
    Imf::MultiPartInputFile parts(input, 0);
    const Imf::Header& header = parts.header(0);
    const Imf::ChannelList& channels = header.channels();
    const std::string prefix = layer.empty() ? "" : layer + ".";
    const auto has = [&](const char* name) { return channels.findChannel(prefix + name) != nullptr; };
    const bool color = has("R") && has("G") && has("B");
    if (!color && (!has("Y") || has("RY")))
        throw Error("{}{} has neither the channels R, G, B nor Y alone{}.", what,
                    layer.empty() ? "" : fmt::format(", layer \"{}\",", shown(layer)), listOfLayers(channels));
    checkClaim(header, bytes.size(), what);
    if (metadata) *metadata = readMetadata(header);
    Imf::InputPart file(parts, 0);
    return readPixels(file, prefix, !color, transparent);
}

} // namespace

bool isExr(std::span<const std::byte> bytes)
{
    return bytes.size() >= 4 && std::memcmp(bytes.data(), "\x76\x2f\x31\x01", 4) == 0;
}

Image decodeExr(std::span<const std::byte> bytes, const std::string& what, Metadata* metadata, bool* transparent,
                const std::string& layer)
{
    try {
        return decode(bytes, what, metadata, transparent, layer);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& reason) {
        std::string text = reason.what();
        while (!text.empty() && (text.back() == '.' || text.back() == '\n')) text.pop_back();
        throw Error("{} is no valid EXR: {}.", what, text);
    }
}

std::vector<std::byte> encodeExr(const Image& image, const Metadata& metadata, std::span<const Layer> layers)
{
    Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer buffer;
    const auto add = [&](const std::string& prefix, const std::string& letters, const Image& picture) {
        CHECK(picture.width == image.width && picture.height == image.height && letters.size() <= 3);
        for (size_t c = 0; c < letters.size(); ++c) {
            header.channels().insert(prefix + letters[c], Imf::Channel(Imf::FLOAT));
            buffer.insert(prefix + letters[c],
                          sliceOf(&picture.pixels.data()->x + c, sizeof(glm::vec3), header.dataWindow(), 0));
        }
    };
    add("", "RGB", image);
    for (const Layer& layer : layers) add(layer.name + ".", layer.channels, layer.picture);
    for (const auto& [key, value] : metadata)
        header.insert(isReserved(key) ? std::string(PREFIX) + key : key, Imf::StringAttribute(value));

    MemoryOutput output;
    {
        Imf::OutputFile file(output, header, 0);
        file.setFrameBuffer(buffer);
        file.writePixels(static_cast<int>(image.height));
    }
    return std::move(output.bytes);
}

} // namespace image
