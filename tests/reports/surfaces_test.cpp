// Reported situations of surfaces: textures, vertex colors, sparse accessors, mirrored nodes, panes.

#include "tests/support/report_case.h"

#include "engine/scene/gltf_loader.h"

#include <cmath>
#include <numbers>

namespace
{

class SurfaceReports : public ReportCase
{
  protected:
    bool arrowPointsRight(size_t command) const
    {
        const image::Image picture = render(command).picture;
        // The texture's arrow points up: from the top rows of 0, 2, 4, ... 14 texels, then eight of 2. Turned, columns
        // from the right.
        for (uint32_t column = 0; column < 16; ++column) {
            uint32_t count = 0;
            for (uint32_t y = 0; y < 16; ++y) count += picture.at(15 - column, y).r > 0.5f;
            if (count != (column < 8 ? 2 * column : 2)) return false;
        }
        return true;
    }

    double meanRed(size_t command) const { return meanOf(render(command).picture).r; }
};

double linear(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

} // namespace

// KHR_texture_transform: uv' = T R S uv. The quad fills the picture, v runs down it.
TEST_F(SurfaceReports, TextureTransform)
{
    open("r01_texture_transform");
    const image::Image picture = render(0).picture;
    const scene::Image texture = scene::loadGltf(path("r01.gltf")).images.at(0);
    const auto isTexel = [&](uint32_t x, uint32_t y, const glm::dvec2& uv) {
        const auto index = [](double t, uint32_t size) { return uint32_t(std::floor((t - std::floor(t)) * size)); };
        const size_t first = 4 * (index(uv.y, texture.height) * texture.width + index(uv.x, texture.width));
        for (int c = 0; c < 3; ++c)
            if (std::abs(picture.at(x, y)[c] - linear(texture.sample(first + size_t(c)))) > 1e-4) return false;
        return true;
    };
    const double c = std::cos(std::numbers::pi / 6), s = std::sin(std::numbers::pi / 6);
    const glm::dvec2 scale(2, 0.5), offset(0.1, 0.2);
    const auto turned = [&](const glm::dvec2& v) { return glm::dvec2(c * v.x + s * v.y, -s * v.x + c * v.y); };
    const auto at = [&](uint32_t x, uint32_t y) {
        return glm::dvec2((x + 0.5) / picture.width, (y + 0.5) / picture.height);
    };
    expect("share of pixels with the texel of T*R*S",
           shareOf(picture, [&](uint32_t x, uint32_t y) { return isTexel(x, y, offset + turned(scale * at(x, y))); }));
    expect("share of T*S*R (the bug)",
           shareOf(picture, [&](uint32_t x, uint32_t y) { return isTexel(x, y, offset + scale * turned(at(x, y))); }));
}

TEST_F(SurfaceReports, TheSenseOfRotation)
{
    open("r02_rotation_sense");
    expect("arrow points right", {arrowPointsRight(0), true});
    expect("arrow points right_texcoord", {arrowPointsRight(1), true});
}

TEST_F(SurfaceReports, PngOf16BitsPalettesAndColorKeys)
{
    open("r05_png_16bit_palette");
    expect("16-bit normal map, x = 0x8000", meanRed(0));
    expect("16-bit normal map, x = 0x8080", meanRed(1));
    expect("16-bit normal map, x = 0x8fff", meanRed(2));

    const auto rgb = [](const glm::dvec3& color) { return nlohmann::json{color.r, color.g, color.b}; };
    const image::Image masked = render(3).picture;
    expect("palette with tRNS, MASK", {rgb(masked.at(0, 1)), rgb(masked.at(1, 1)), rgb(masked.at(2, 1))});
    const image::Image blended = render(4).picture;
    glm::dvec3 sum(0);
    for (const auto& [x, y] : {std::pair{6u, 3u}, {6u, 4u}, {7u, 3u}, {7u, 4u}, {7u, 5u}, {8u, 3u}, {8u, 4u}, {8u, 5u}})
        sum += glm::dvec3(blended.at(x, y)) / 8.0;
    expect("palette with tRNS 128, BLEND (not on the diagonal: n01)", rgb(sum));
    const image::Image keyed = render(5).picture;
    expect("gray with tRNS color key", {keyed.at(0, 0).r, keyed.at(1, 0).r});
}

TEST_F(SurfaceReports, VertexColorsOfEveryType)
{
    open("r06_color0");
    const char* const names[] = {"u8 VEC3", "u8 VEC4", "u16 VEC3", "u16 VEC4", "f32 VEC3", "f32 VEC4"};
    for (size_t i = 0; i < std::size(names); ++i)
        expect(names[i], meanOf(render(i, Warns::Yes).picture).r); // warns: the sky is the program's
}

TEST_F(SurfaceReports, SparseAccessors)
{
    open("r09_sparse");
    const image::Image square = render(0).picture;
    const double share = shareOf(square, [&](uint32_t x, uint32_t y) { return square.at(x, y).r > 0; });
    expect("zeros + overrides: the unit square", {share, largestOf(square)});
    const Rendered furnace = render(1, Warns::Yes);
    expect("furnace with zero normals", meanOf(furnace.picture).r);
    expect("warns", furnace.err.find("normal") != std::string::npos);
}

TEST_F(SurfaceReports, MirroredNodes)
{
    open("r10_mirrored");
    expect("scale [-1, 1, 1]: emission towards +z", meanRed(0));
    expect("scale [1, 1, -1]: emission towards +z", meanRed(1));
    expect("scale [-1, -1, -1]: emission towards +z", meanRed(2));
    expect("scale [-1, -1, 1]: emission towards +z", meanRed(3));
    const image::Image ball = render(4).picture, mirrored = render(5).picture;
    const auto isEqual = [&](uint32_t x, uint32_t y) {
        const glm::vec3 difference = ball.at(x, y) - mirrored.at(ball.width - 1 - x, y);
        return std::abs(difference.r) < 1e-3f && std::abs(difference.g) < 1e-3f && std::abs(difference.b) < 1e-3f;
    };
    expect("mirror picture: share of pixels within 1e-3", shareOf(ball, isEqual));
    const glm::dvec3 difference = meanOf(mirrored) - meanOf(ball);
    expect("means", {difference.r, difference.g, difference.b});
}

// A pane of alpha 0.5 before a white wall. 0.4 is nine standard deviations below its mean in 2048 frames.
TEST_F(SurfaceReports, TheDiagonalOfABlendedQuad)
{
    open("n01_blend_diagonal");
    const char* const names[] = {"ortho 32x32: pixels on the diagonal darker than 0.4 of 32",
                                 "ortho 33x33: pixels on the diagonal darker than 0.4 of 33",
                                 "perspective 32x32: pixels on the diagonal darker than 0.4 of 32",
                                 "perspective 33x33: pixels on the diagonal darker than 0.4 of 33"};
    const auto diagonal = [](const image::Image& picture) {
        std::vector<float> values;
        for (uint32_t x = 0; x < picture.width; ++x) values.push_back(picture.at(x, picture.height - 1 - x).r);
        return values;
    };
    for (size_t i = 0; i < std::size(names); ++i) {
        const std::vector<float> values = diagonal(render(i).picture);
        expect(names[i], std::ranges::count_if(values, [](float value) { return value < 0.4f; }));
    }
    const std::vector<float> boxed = diagonal(render(4).picture);
    expect("box filter: darkest on the diagonal", *std::ranges::min_element(boxed));
}

// Absorption in volumes is not there yet.
TEST_F(SurfaceReports, AttenuationInVolumes)
{
    open("r17_attenuation");
    const auto rgb = [&](size_t command) {
        const glm::dvec3 color = meanOf(render(command, Warns::Yes).picture);
        return nlohmann::json{color.r, color.g, color.b};
    };
    expectNotYet("scale 1", rgb(0));
    expectNotYet("scale 2", rgb(1));
    expect("ior 1.5 warns", render(2, Warns::Yes).err.find("attenuation") != std::string::npos);
}

// Many exporters write "../textures/x.png". Beyond the scene's folder only the option opens a folder: the manifest's
// command, which has no way to name it, is refused with a sentence that does.
TEST_F(SurfaceReports, TexturesBesideTheScenesFolder)
{
    open("n03_paths_outside");
    for (const char* folder : {"asset/scenes", "asset/textures"})
        std::filesystem::create_directories(directory / folder);
    image::write(directory / "asset/textures/x.png", {1, 1, {glm::vec3(1)}}, {});
    writeFile(directory / "asset/scenes/s.gltf", R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "materials": [{"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}}],
        "textures": [{"source": 0}], "images": [{"uri": "../textures/x.png"}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
    expect("loads", runCommand(0, {"--asset-root", directory / "asset"}).exitCode);
    EXPECT_EQ(image::read(directory / "out.exr").image.pixels.size(), 64u);
    const Outcome refused = runCommand(0);
    EXPECT_EQ(refused.exitCode, 1);
    EXPECT_NE(refused.err.find("\"../textures/x.png\""), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("--asset-root DIR"), std::string::npos) << refused.err;
    EXPECT_EQ(runCommand(0, {"--asset-root", directory / "asset/scenes"}).exitCode, 1);
}
