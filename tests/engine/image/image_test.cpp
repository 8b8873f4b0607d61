#include "engine/image/image.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/files.h"

using namespace std::string_view_literals;

namespace
{

class ImageFile : public testing::Test
{
  protected:
    void SetUp() override
    {
        std::string pattern = testing::TempDir() + "trichrome_image_XXXXXX";
        folder = ::mkdtemp(pattern.data());
    }
    void TearDown() override { std::filesystem::remove_all(folder); }

    std::filesystem::path save(const std::string& name, std::string_view bytes) const
    {
        std::ofstream(folder / name, std::ios::binary) << bytes;
        return folder / name;
    }
    static std::string messageOf(const std::filesystem::path& path, const std::string& layer = "")
    {
        try {
            image::read(path, layer);
        } catch (const Error& error) {
            return error.what();
        }
        return "no error";
    }

    std::filesystem::path folder;
};

// Every pixel differs; the values span what radiance does.
image::Image sample(uint32_t width, uint32_t height)
{
    image::Image image{width, height, {}};
    for (uint32_t i = 0; i < width * height; ++i)
        image.pixels.emplace_back(0.001f * float(i), std::exp2(float(i % 40) - 20), 1 / (1 + float(i)));
    return image;
}

std::string valueOf(const image::Metadata& metadata, const std::string& key)
{
    for (const auto& [name, value] : metadata)
        if (name == key) return value;
    return "(none)";
}

} // namespace

TEST_F(ImageFile, ExrKeepsEveryBitAndTheMetadata)
{
    image::Image image = sample(37, 300); // more rows than are read at once
    image.at(3, 2) = {std::numeric_limits<float>::quiet_NaN(), -1, std::numeric_limits<float>::infinity()};
    image::write(folder / "a.exr", image,
                 {{"seed", "7"}, {"version", "0.1"}, {"max-confidence", "20"}, {"camera", ""}});
    const image::Loaded back = image::read(folder / "a.exr");
    ASSERT_EQ(back.image.width, 37u);
    ASSERT_EQ(back.image.height, 300u);
    EXPECT_EQ(std::memcmp(back.image.pixels.data(), image.pixels.data(), image.pixels.size() * sizeof(glm::vec3)), 0);
    EXPECT_EQ(back.metadata,
              (image::Metadata{{"camera", ""}, {"max-confidence", "20"}, {"seed", "7"}, {"version", "0.1"}}));
}

TEST_F(ImageFile, LayersOfAnExrAreReadByName)
{
    const image::Image image = sample(37, 300), other = sample(37, 300);
    image::Image depth = other;
    for (glm::vec3& pixel : depth.pixels) pixel = 1.0f - pixel;
    image::write(folder / "plain.exr", image, {{"seed", "7"}});
    image::write(folder / "a.exr", image, {{"seed", "7"}}, {{"light.direct", "RGB", depth}, {"depth", "Y", depth}});
    const auto layer = [&](const std::string& name) { return image::read(folder / "a.exr", name).image.pixels; };
    EXPECT_EQ(layer(""), image.pixels);
    EXPECT_EQ(layer("light.direct"), depth.pixels);
    EXPECT_EQ(layer("depth").at(99), glm::vec3(depth.pixels[99].x));
    EXPECT_EQ(image::read(folder / "a.exr", "depth").metadata, image::read(folder / "plain.exr").metadata);
    EXPECT_EQ(messageOf(folder / "a.exr", "dept"),
              "Picture \"" + (folder / "a.exr").string() +
                  "\", layer \"dept\", has neither the channels R, G, B nor Y alone; its layers are \"depth\", "
                  "\"light.direct\".");
    image::write(folder / "a.png", image, {});
    EXPECT_EQ(messageOf(folder / "a.png", "x\n"),
              "Picture \"" + (folder / "a.png").string() + "\" is no EXR, so it has no layer \"x?\".");
}

// Of a stranger's file: the names that there are, as far as a sentence can hold them.
TEST_F(ImageFile, AnExrOfNamedLayersOnlySaysWhichThereAre)
{
    const std::vector<float> samples(4, 0.5f);
    const auto save = [&](const std::string& prefix, int count) {
        Imf::Header header(2, 2);
        Imf::FrameBuffer buffer;
        for (int i = 0; i < count; ++i)
            for (const char channel : {'R', 'G', 'B'}) {
                const std::string name = prefix + std::to_string(i) + "." + channel;
                header.channels().insert(name, Imf::Channel(Imf::FLOAT));
                auto* pixels = reinterpret_cast<char*>(const_cast<float*>(samples.data())); // only read
                buffer.insert(name, Imf::Slice(Imf::FLOAT, pixels, sizeof(float), 2 * sizeof(float)));
            }
        Imf::OutputFile file((folder / "named.exr").c_str(), header, 0);
        file.setFrameBuffer(buffer);
        file.writePixels(2);
    };
    save("view\n", 2);
    EXPECT_EQ(messageOf(folder / "named.exr"),
              "Picture \"" + (folder / "named.exr").string() +
                  "\" has neither the channels R, G, B nor Y alone; its layers are \"view?0\", \"view?1\".");
    EXPECT_EQ(image::read(folder / "named.exr", "view\n1").image.pixels.at(3), glm::vec3(0.5f));
    save("x", 1000);
    EXPECT_LT(messageOf(folder / "named.exr").size(), 400u);
    EXPECT_TRUE(messageOf(folder / "named.exr").ends_with("\" and others."));
}

TEST_F(ImageFile, PngIsReinhardAndSrgbAndReadsBack)
{
    image::Image image{5, 1, {glm::vec3(0), glm::vec3(1), {1e9f, -3, 0.18f}, glm::vec3(0.25f), glm::vec3(4)}};
    image::write(folder / "a.PNG", image, {{"method", "pt"}});
    const image::Loaded back = image::read(folder / "a.PNG");
    EXPECT_EQ(valueOf(back.metadata, "method"), "pt");
    EXPECT_EQ(back.image.pixels[0], glm::vec3(0));
    EXPECT_NEAR(back.image.pixels[1].x, 1, 0.02); // mapped to 0.5, encoded as 188
    EXPECT_NEAR(back.image.pixels[2].y, 0, 1e-6);
    EXPECT_NEAR(back.image.pixels[2].z, 0.18, 0.002);
    EXPECT_GT(back.image.pixels[2].x, 200); // white: brighter than what 8 bits resolve
    EXPECT_NEAR(back.image.pixels[3].x, 0.25, 0.003);
    EXPECT_NEAR(back.image.pixels[4].x, 4, 0.1);
}

TEST_F(ImageFile, ForeignPngIsPlainSrgb)
{
    image::write(folder / "a.png", {1, 1, {glm::vec3(1)}}, {});
    std::vector<std::byte> bytes = files::read(folder / "a.png");
    std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    text.erase(text.find("tEXt") - 4, 12 + 11 + 1 + 22); // our mark; length, name, keyword, NUL, value, CRC
    EXPECT_NEAR(image::read(save("b.png", text)).image.pixels[0].x, 0.5, 0.004);
}

TEST_F(ImageFile, ReadsRadianceHdr)
{
    std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 1\n";
    text += {char(128), char(64), char(0), char(129)}; // mantissa 128/256 * 2^1
    text += {char(255), char(255), char(255), char(120)};
    const image::Image image = image::read(save("a.hdr", text)).image;
    ASSERT_EQ(image.height, 2u);
    EXPECT_EQ(image.pixels[0], glm::vec3(1, 0.5f, 0));
    EXPECT_EQ(image.pixels[1], glm::vec3(std::ldexp(255.0f, 120 - 136)));
}

TEST_F(ImageFile, MalformedFilesAreErrors)
{
    image::write(folder / "ok.exr", sample(64, 64), {});
    const std::vector<std::byte> bytes = files::read(folder / "ok.exr");
    const std::string exr(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (size_t length = 0; length < exr.size(); length += 37)
        EXPECT_NE(messageOf(save("cut.exr", exr.substr(0, length))), "no error") << length;

    std::string huge = exr; // the data window's right and lower ends
    const size_t window = huge.find("dataWindow") + 10 + 1 + 5 + 1 + 4;
    for (size_t i = 8; i < 16; ++i) huge[window + i] = i % 4 == 3 ? '\x7f' : '\xff';
    EXPECT_NE(messageOf(save("huge.exr", huge)), "no error");

    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    EXPECT_NE(messageOf(save("a.hdr", header + "-Y 2 +X 2\n1234")).find("cut short"), std::string::npos);
    const std::string row = header + "-Y 2 +X 16\n\x02\x02"; // of the run-length form
    EXPECT_NE(messageOf(save("r.hdr", row + std::string("\0\x10", 2))).find("cut short"), std::string::npos);
    EXPECT_NE(messageOf(save("b.hdr", header + "-Y 60000 +X 60000\n1234")).find("60000 x 60000"), std::string::npos);
    EXPECT_EQ(messageOf(save("c.txt", "hello")),
              "Picture \"" + (folder / "c.txt").string() + "\" (5 bytes) is neither EXR, HDR, PNG nor JPEG.");
}

// Decoding takes memory by the header alone, so a header that no such file can keep is refused before.
TEST_F(ImageFile, AnExrThatClaimsMoreThanItCanHoldIsRefused)
{
    image::write(folder / "ok.exr", sample(64, 64), {});
    const std::vector<std::byte> bytes = files::read(folder / "ok.exr");
    const std::string good(reinterpret_cast<const char*>(bytes.data()), bytes.size());

    std::string longer = good; // an attribute: 395 bytes made OpenEXR take 2 GB
    longer.replace(longer.find("lineOrder") + 9 + 1 + 9 + 1, 4, "\xff\xff\xff\x7f");
    EXPECT_EQ(messageOf(save("longer.exr", longer)),
              "Picture \"" + (folder / "longer.exr").string() + "\" is cut short, or claims to be longer than it is.");

    std::string wrong = good; // of fixed size: OpenEXR would read on inside the next attribute
    wrong.replace(wrong.find("screenWindowWidth") + 17 + 1 + 5 + 1, 1, "\x03");
    EXPECT_EQ(messageOf(save("wrong.exr", wrong)),
              "Picture \"" + (folder / "wrong.exr").string() +
                  "\", attribute screenWindowWidth, has 3 bytes, which none of the type float has.");

    std::string claims = good;
    const size_t right = claims.find("dataWindow") + 10 + 1 + 5 + 1 + 4 + 8;
    claims.replace(right, 8, std::string("\xff\x7f\0\0\xff\x0f\0\0", 8));
    EXPECT_EQ(messageOf(save("claims.exr", claims)), "Picture \"" + (folder / "claims.exr").string() +
                                                         "\" claims 32768 x 4096 pixels, more than its " +
                                                         std::to_string(bytes.size()) + " bytes can hold.");
}

// The other end of that limit: nothing gets smaller than a picture of one value in tiles as large as it.
TEST_F(ImageFile, ReadsAnExrOfOneValueHoweverSmallItsFile)
{
    constexpr int SIDE = 2048;
    const std::vector<float> even(size_t{SIDE} * SIDE, 0.5f);
    for (const Imf::Compression compression : {Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION,
                                               Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION}) {
        Imf::Header header(SIDE, SIDE);
        header.compression() = compression;
        header.setTileDescription(Imf::TileDescription(SIDE, SIDE));
        Imf::FrameBuffer buffer;
        for (const char* name : {"R", "G", "B"}) {
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            auto* pixels = reinterpret_cast<char*>(const_cast<float*>(even.data())); // only read
            buffer.insert(name, Imf::Slice(Imf::FLOAT, pixels, sizeof(float), SIDE * sizeof(float)));
        }
        {
            Imf::TiledOutputFile file((folder / "even.exr").c_str(), header, 0);
            file.setFrameBuffer(buffer);
            file.writeTile(0, 0);
        }
        const image::Image back = image::read(folder / "even.exr").image;
        ASSERT_EQ(back.pixels.size(), even.size()) << compression;
        EXPECT_NEAR(back.pixels.back().y, 0.5, 1e-3) << compression;
    }
}

// Of more rows than are read at once; said when it is anywhere not 1, whatever the kind of file.
TEST_F(ImageFile, AlphaIsIgnoredAndSaidToBe)
{
    constexpr int WIDTH = 3, HEIGHT = 600;
    const auto warnings = [&](float lastAlpha) {
        std::vector<float> color(size_t{WIDTH} * HEIGHT, 0.25f), alpha(size_t{WIDTH} * HEIGHT, 1);
        alpha.back() = lastAlpha;
        Imf::Header header(WIDTH, HEIGHT);
        Imf::FrameBuffer buffer;
        for (const char* name : {"R", "G", "B", "A"}) {
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            auto* samples = reinterpret_cast<char*>(*name == 'A' ? alpha.data() : color.data());
            buffer.insert(name, Imf::Slice(Imf::FLOAT, samples, sizeof(float), WIDTH * sizeof(float)));
        }
        {
            Imf::OutputFile file((folder / "alpha.exr").c_str(), header, 0);
            file.setFrameBuffer(buffer);
            file.writePixels(HEIGHT);
        }
        const image::Loaded loaded = image::read(folder / "alpha.exr");
        EXPECT_EQ(loaded.image.pixels.back(), glm::vec3(0.25f));
        return loaded.warnings;
    };
    EXPECT_EQ(warnings(1), std::vector<std::string>{});
    EXPECT_EQ(warnings(0.99f),
              std::vector<std::string>{"Picture \"" + (folder / "alpha.exr").string() +
                                       "\" has an alpha channel that is not 1 everywhere: it is ignored."});

    const std::string_view png = // one pixel, white, alpha 254
        "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\b\6\0\0\0\x1f\x15\xc4\x89\0\0\0\rIDATx\xda"
        "c\xf8\xff\xff\xff?\0\t\xfa\3\xfc\x8c"
        "E\xa1W\0\0\0\0IEND\xae"
        "B`\x82"sv;
    const image::Loaded loaded = image::read(save("alpha.png", png));
    EXPECT_EQ(loaded.image.pixels.at(0), glm::vec3(1));
    EXPECT_EQ(loaded.warnings.size(), 1u);
}

TEST_F(ImageFile, FlippedBytesOfAnExrNeverCrash)
{
    image::write(folder / "ok.exr", sample(20, 20), {{"a", "b"}});
    const std::vector<std::byte> bytes = files::read(folder / "ok.exr");
    for (size_t i = 4; i < 700 && i < bytes.size(); ++i) {
        std::string broken(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        broken[i] = char(broken[i] ^ 0x81);
        messageOf(save("broken.exr", broken)); // any picture or Error
    }
}

TEST_F(ImageFile, WritesToNoOtherNames)
{
    EXPECT_THROW(image::write(folder / "a.jpg", sample(2, 2), {}), Error);
    EXPECT_THROW(image::write(folder / "none" / "a.exr", sample(2, 2), {}), Error);
    EXPECT_THROW(image::requireWritable(folder / "none" / "a.exr"), Error);
    std::filesystem::create_directory(folder / "dir.exr");
    EXPECT_THROW(image::requireWritable(folder / "dir.exr"), Error);
    EXPECT_NO_THROW(image::requireWritable("a.exr"));
    EXPECT_TRUE(std::filesystem::is_empty(folder / "dir.exr"));
}
