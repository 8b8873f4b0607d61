// JPEG through libjpeg-turbo. It reports by longjmp: between setjmp and the jump live only plain values.

#include "engine/image/codecs.h"

#include <array>
#include <csetjmp>
#include <cstdio>

#include <jpeglib.h> // needs <cstdio> first

#include <jerror.h>

#include "engine/base/check.h"
#include "engine/base/error.h"

namespace image
{

namespace
{

// A flat 8x8 block of a progressive grey file takes a bit or more; nothing sensible packs more than this.
constexpr uint64_t MAX_PIXELS_PER_BYTE = 1024;
constexpr int MAX_SCANS = 500; // progressive files can repeat full-size scans of no content
constexpr long MAX_WORKING_MEMORY = 1L << 30;

struct Reader {
    jpeg_decompress_struct decoder = {};
    jpeg_error_mgr errors = {};
    jpeg_progress_mgr progress = {};
    std::jmp_buf onError;
    std::array<char, JMSG_LENGTH_MAX> reason = {};

    ~Reader() { jpeg_destroy_decompress(&decoder); }
};

Reader& readerOf(j_common_ptr common)
{
    return *static_cast<Reader*>(common->client_data);
}

[[noreturn]] void fail(j_common_ptr common)
{
    Reader& reader = readerOf(common);
    common->err->format_message(common, reader.reason.data());
    std::longjmp(reader.onError, 1);
}

void onMessage(j_common_ptr common, int level)
{
    const int code = common->err->msg_code;
    if (level < 0 && (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER)) fail(common); // else grey would fill the rest
}

void onProgress(j_common_ptr common)
{
    if (readerOf(common).decoder.input_scan_number <= MAX_SCANS) return;
    Reader& reader = readerOf(common);
    std::snprintf(reader.reason.data(), reader.reason.size(), "more than %d scans", MAX_SCANS);
    std::longjmp(reader.onError, 1);
}

bool readHeader(Reader& reader, std::span<const std::byte> bytes)
{
    if (setjmp(reader.onError)) return false;
    jpeg_create_decompress(&reader.decoder);
    reader.decoder.client_data = &reader;
    reader.decoder.progress = &reader.progress;
    reader.decoder.mem->max_memory_to_use = MAX_WORKING_MEMORY;
    jpeg_mem_src(&reader.decoder, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&reader.decoder, TRUE);
    return true;
}

bool readRows(Reader& reader, uint8_t* rgba)
{
    if (setjmp(reader.onError)) return false;
    reader.decoder.out_color_space = JCS_EXT_RGBA;
    jpeg_start_decompress(&reader.decoder);
    while (reader.decoder.output_scanline < reader.decoder.output_height) {
        JSAMPROW row = rgba + size_t{4} * reader.decoder.output_width * reader.decoder.output_scanline;
        jpeg_read_scanlines(&reader.decoder, &row, 1);
    }
    jpeg_finish_decompress(&reader.decoder);
    return true;
}

} // namespace

bool isJpeg(std::span<const std::byte> bytes)
{
    return bytes.size() >= 3 && bytes[0] == std::byte{0xff} && bytes[1] == std::byte{0xd8} &&
           bytes[2] == std::byte{0xff};
}

Raster<uint8_t> decodeJpeg(std::span<const std::byte> bytes, const std::string& what)
{
    Reader reader;
    reader.decoder.err = jpeg_std_error(&reader.errors);
    reader.decoder.client_data = &reader;
    reader.errors.error_exit = fail;
    reader.errors.emit_message = onMessage;
    reader.progress.progress_monitor = onProgress;
    const auto malformed = [&] { return Error("{} is no valid JPEG: {}.", what, reader.reason.data()); };

    if (!readHeader(reader, bytes)) throw malformed();
    const uint64_t width = reader.decoder.image_width;
    const uint64_t height = reader.decoder.image_height;
    requirePlausible(what, width, height, width * height <= MAX_PIXELS_PER_BYTE * bytes.size(), bytes.size());

    const J_COLOR_SPACE colors = reader.decoder.jpeg_color_space;
    if (colors == JCS_CMYK || colors == JCS_YCCK)
        throw Error("{} is a JPEG of printing inks (CMYK), whose colors depend on paper and press: save it as RGB.",
                    what);

    Raster<uint8_t> raster{static_cast<uint32_t>(width), static_cast<uint32_t>(height), {}};
    raster.rgba.resize(width * height * 4);
    if (!readRows(reader, raster.rgba.data())) throw malformed();
    return raster;
}

} // namespace image
