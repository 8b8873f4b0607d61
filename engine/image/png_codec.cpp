// PNG through libpng. libpng reports by longjmp: between setjmp and the jump live only plain values.

#include "engine/image/codecs.h"

#include <algorithm>
#include <csetjmp>
#include <cstdlib>
#include <cstring>
#include <type_traits>

#include <png.h>

#include "engine/base/check.h"
#include "engine/base/error.h"

namespace image
{

namespace
{

// Deflate cannot expand by more than this (RFC 1951: 258 bytes from 2 bits).
constexpr uint64_t MAX_DEFLATE_RATIO = 1032;
constexpr uint64_t LIBPNG_BYTES = 1 << 20; // the largest piece of what it needs for itself

// Everything a longjmp may skip over, owned outside of the function that calls setjmp.
struct Reader {
    std::span<const std::byte> rest;
    uint64_t mostBytes; // that libpng may have at once
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::string reason;

    ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

struct Writer {
    std::vector<std::byte> bytes;
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::string reason;

    ~Writer() { png_destroy_write_struct(&png, &info); }
};

template <class Side>
[[noreturn]] void onError(png_structp png, png_const_charp message)
{
    static_cast<Side*>(png_get_error_ptr(png))->reason = message;
    png_longjmp(png, 1);
}

void onWarning(png_structp, png_const_charp) {}

// libpng takes memory for as much as a chunk claims to be long, and only warns where that is beyond its limit.
png_voidp allocate(png_structp png, png_alloc_size_t size)
{
    return size <= static_cast<const Reader*>(png_get_mem_ptr(png))->mostBytes ? std::malloc(size) : nullptr;
}

void release(png_structp, png_voidp memory)
{
    std::free(memory);
}

void readBytes(png_structp png, png_bytep to, size_t count)
{
    auto& rest = static_cast<Reader*>(png_get_io_ptr(png))->rest;
    if (count > rest.size()) png_error(png, "it is cut short");
    std::memcpy(to, rest.data(), count);
    rest = rest.subspan(count);
}

void writeBytes(png_structp png, png_bytep from, size_t count)
{
    auto& bytes = static_cast<Writer*>(png_get_io_ptr(png))->bytes;
    const auto* first = reinterpret_cast<const std::byte*>(from);
    bytes.insert(bytes.end(), first, first + count);
}

// False, here and below: `reason` says why.
bool readHeader(Reader& reader)
{
    if (setjmp(png_jmpbuf(reader.png))) return false;
    png_set_read_fn(reader.png, &reader, readBytes);
    png_set_user_limits(reader.png, 0x7fffffff, 0x7fffffff); // our own limit gives the better message
    png_set_chunk_malloc_max(reader.png, 1 << 24);
    png_set_chunk_cache_max(reader.png, 1000);
    png_read_info(reader.png, reader.info);
    return true;
}

// Asks libpng for RGBA of the sample's width, whatever the file holds.
bool prepareRows(Reader& reader, bool sixteenBit)
{
    if (setjmp(png_jmpbuf(reader.png))) return false;
    if (sixteenBit) {
        png_set_expand_16(reader.png);
        png_set_swap(reader.png); // PNG is big-endian
    } else {
        png_set_expand(reader.png);
        png_set_scale_16(reader.png);
    }
    png_set_gray_to_rgb(reader.png);
    png_set_add_alpha(reader.png, 0xffff, PNG_FILLER_AFTER);
    png_set_interlace_handling(reader.png);
    png_read_update_info(reader.png, reader.info);
    return true;
}

bool readRows(Reader& reader, png_bytepp rows)
{
    if (setjmp(png_jmpbuf(reader.png))) return false;
    png_read_image(reader.png, rows);
    png_read_end(reader.png, reader.info);
    return true;
}

bool writeAll(Writer& writer, uint32_t width, uint32_t height, png_bytepp rows, png_textp texts, int textCount)
{
    if (setjmp(png_jmpbuf(writer.png))) return false;
    png_set_write_fn(writer.png, &writer, writeBytes, nullptr);
    png_set_IHDR(writer.png, writer.info, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_RELATIVE);
    png_set_text(writer.png, writer.info, texts, textCount);
    png_write_info(writer.png, writer.info);
    png_write_image(writer.png, rows);
    png_write_end(writer.png, writer.info);
    return true;
}

} // namespace

bool isPng(std::span<const std::byte> bytes)
{
    return bytes.size() >= 8 && png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, 8) == 0;
}

// Its header comes first (PNG, 11.2.2): 8 bytes of signature, 8 of the chunk's length and type, width, height, depth.
uint32_t pngBitDepth(std::span<const std::byte> bytes)
{
    return bytes.size() > 24 ? static_cast<uint32_t>(bytes[24]) : 0;
}

template <class Sample>
Raster<Sample> decodePng(std::span<const std::byte> bytes, const std::string& what, Metadata* metadata)
{
    constexpr bool SIXTEEN_BIT = std::is_same_v<Sample, uint16_t>;
    Reader reader{.rest = bytes, .mostBytes = LIBPNG_BYTES + MAX_DEFLATE_RATIO * bytes.size()};
    reader.png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &reader, onError<Reader>, onWarning, &reader, allocate,
                                          release);
    CHECK(reader.png != nullptr);
    reader.info = png_create_info_struct(reader.png);
    CHECK(reader.info != nullptr);
    const auto malformed = [&] { return Error("{} is no valid PNG: {}.", what, reader.reason); };

    if (!readHeader(reader)) throw malformed();
    const uint64_t width = png_get_image_width(reader.png, reader.info);
    const uint64_t height = png_get_image_height(reader.png, reader.info);
    requirePlausible(what, width, height,
                     png_get_rowbytes(reader.png, reader.info) * height <= MAX_DEFLATE_RATIO * bytes.size(),
                     bytes.size());
    reader.mostBytes += width * 4 * sizeof(uint16_t); // a row, whatever the sample

    if (!prepareRows(reader, SIXTEEN_BIT)) throw malformed();
    CHECK_EQ(png_get_rowbytes(reader.png, reader.info), width * 4 * sizeof(Sample));
    Raster<Sample> raster{static_cast<uint32_t>(width), static_cast<uint32_t>(height), {}};
    raster.rgba.resize(width * height * 4);
    std::vector<png_bytep> rows(height);
    for (uint64_t y = 0; y < height; ++y) rows[y] = reinterpret_cast<png_bytep>(&raster.rgba[y * width * 4]);
    if (!readRows(reader, rows.data())) throw malformed();

    if (metadata) {
        png_textp texts = nullptr;
        const int count = png_get_text(reader.png, reader.info, &texts, nullptr);
        for (int i = 0; i < count; ++i) metadata->emplace_back(texts[i].key, texts[i].text);
    }
    return raster;
}

template Raster<uint8_t> decodePng(std::span<const std::byte>, const std::string&, Metadata*);
template Raster<uint16_t> decodePng(std::span<const std::byte>, const std::string&, Metadata*);

std::vector<std::byte> encodePng(uint32_t width, uint32_t height, std::span<const uint8_t> rgb,
                                 const Metadata& metadata)
{
    CHECK_EQ(rgb.size(), size_t{3} * width * height);
    Writer writer;
    writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer, onError<Writer>, onWarning);
    CHECK(writer.png != nullptr);
    writer.info = png_create_info_struct(writer.png);
    CHECK(writer.info != nullptr);

    // libpng takes pointers to mutable data but does not write through them.
    std::vector<png_bytep> rows(height);
    for (size_t y = 0; y < height; ++y) rows[y] = const_cast<png_bytep>(&rgb[y * width * 3]);
    std::vector<png_text> texts;
    for (const auto& [key, value] : metadata) {
        png_text text = {};
        text.compression = PNG_TEXT_COMPRESSION_NONE;
        text.key = const_cast<png_charp>(key.c_str());
        text.text = const_cast<png_charp>(value.c_str());
        text.text_length = value.size();
        texts.push_back(text);
    }
    if (!writeAll(writer, width, height, rows.data(), texts.data(), static_cast<int>(texts.size())))
        throw Error("Cannot encode a PNG of {} x {} pixels: {}.", width, height, writer.reason);
    return std::move(writer.bytes);
}

} // namespace image
