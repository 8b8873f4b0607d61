// Covers engine/image/exr_attributes.cpp, engine/image/exr_codec.cpp, engine/image/hdr_codec.cpp,
// engine/image/jpeg_codec.cpp, engine/image/png_codec.cpp.

#include "engine/image/codecs.h"

#include <csetjmp>
#include <cstdio>

#include <jpeglib.h> // needs <cstdio> first

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/files.h"

namespace
{

std::vector<std::byte> jpeg(uint32_t width, uint32_t height, const std::vector<uint8_t>& samples,
                            J_COLOR_SPACE colors = JCS_RGB)
{
    jpeg_compress_struct encoder = {};
    jpeg_error_mgr errors = {};
    encoder.err = jpeg_std_error(&errors);
    jpeg_create_compress(&encoder);
    unsigned char* data = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&encoder, &data, &size);
    encoder.image_width = width;
    encoder.image_height = height;
    encoder.input_components = colors == JCS_CMYK ? 4 : 3;
    encoder.in_color_space = colors;
    jpeg_set_defaults(&encoder);
    jpeg_set_quality(&encoder, 100, TRUE);
    jpeg_start_compress(&encoder, TRUE);
    for (uint32_t y = 0; y < height; ++y) {
        auto* row = const_cast<JSAMPROW>(&samples[size_t(encoder.input_components) * width * y]);
        jpeg_write_scanlines(&encoder, &row, 1);
    }
    jpeg_finish_compress(&encoder);
    const auto* first = reinterpret_cast<const std::byte*>(data);
    std::vector<std::byte> bytes(first, first + size);
    jpeg_destroy_compress(&encoder);
    std::free(data);
    return bytes;
}

// The outcome of decoding every prefix of a file that is not the whole of it.
template <class Decode>
void expectErrorsWhenCut(const std::vector<std::byte>& bytes, size_t end, const Decode& decode)
{
    for (size_t length = 0; length < end; ++length)
        EXPECT_THROW(decode(std::span(bytes).first(length)), Error) << length;
}

} // namespace

TEST(PngCodec, RoundTrip)
{
    const std::vector<uint8_t> rgb = {1, 2, 3, 255, 0, 128, 7, 7, 7, 90, 91, 92, 0, 0, 0, 255, 255, 255};
    const auto bytes = image::encodePng(3, 2, rgb, {{"key", "value"}, {"empty", ""}});
    ASSERT_TRUE(image::isPng(bytes));
    image::Metadata metadata;
    const auto raster = image::decodePng<uint8_t>(bytes, "it", &metadata);
    EXPECT_EQ(raster.width, 3u);
    EXPECT_EQ(raster.height, 2u);
    EXPECT_EQ(metadata, (image::Metadata{{"key", "value"}, {"empty", ""}}));
    const auto wide = image::decodePng<uint16_t>(bytes, "it");
    for (size_t i = 0; i < 6; ++i) {
        for (size_t c = 0; c < 3; ++c) {
            EXPECT_EQ(raster.rgba[4 * i + c], rgb[3 * i + c]);
            EXPECT_EQ(wide.rgba[4 * i + c], rgb[3 * i + c] * 257);
        }
        EXPECT_EQ(raster.rgba[4 * i + 3], 255);
        EXPECT_EQ(wide.rgba[4 * i + 3], 65535);
    }
}

TEST(PngCodec, CutFilesAreErrors)
{
    const auto bytes = image::encodePng(20, 20, std::vector<uint8_t>(1200, 77), {});
    expectErrorsWhenCut(bytes, bytes.size(), [](auto part) { image::decodePng<uint8_t>(part, "it"); });
}

// A text chunk that claims 1.7 GB, in 103 bytes: with its memory at hand libpng reads on, and finds the file cut short.
TEST(PngCodec, AChunkGetsNoMoreMemoryThanTheFileWarrants)
{
    const auto bytes = files::read(TRICHROME_SOURCE_DIR "/tests/fuzz/corpus/png/text_of_1_7_gb.png");
    try {
        image::decodePng<uint8_t>(bytes, "it");
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find("cut short"), std::string::npos) << error.what(); // it read on, then
    }
}

TEST(JpegCodec, DecodesColorsTopRowFirst)
{
    std::vector<uint8_t> rgb; // 16 x 16 red over 16 x 16 blue
    for (int i = 0; i < 512; ++i) rgb.insert(rgb.end(), {uint8_t(i < 256 ? 200 : 0), 0, uint8_t(i < 256 ? 0 : 200)});
    const auto bytes = jpeg(16, 32, rgb);
    ASSERT_TRUE(image::isJpeg(bytes));
    const auto raster = image::decodeJpeg(bytes, "it");
    ASSERT_EQ(raster.rgba.size(), 16u * 32 * 4);
    for (const size_t i : {size_t{0}, size_t{511}}) {
        for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(raster.rgba[4 * i + c], rgb[3 * i + c], 3);
        EXPECT_EQ(raster.rgba[4 * i + 3], 255);
    }
}

// As Photoshop writes them, too, whose marker says that the inks are inverted.
TEST(JpegCodec, OfInksIsRefusedForWhatItIs)
{
    try {
        image::decodeJpeg(jpeg(8, 8, std::vector<uint8_t>(size_t{4} * 64, 100), JCS_CMYK), "Image \"it\"");
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()),
                  "Image \"it\" is a JPEG of printing inks (CMYK), whose colors depend on paper "
                  "and press: save it as RGB.");
    }
}

TEST(JpegCodec, CutFilesAreErrors)
{
    std::vector<uint8_t> rgb;
    for (int i = 0; i < 3 * 32 * 32; ++i) rgb.push_back(uint8_t(i * 31));
    const auto bytes = jpeg(32, 32, rgb);
    expectErrorsWhenCut(bytes, bytes.size() - 40, [](auto part) { image::decodeJpeg(part, "it"); });
}
