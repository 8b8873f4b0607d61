// Reported situations of light: spots, emitters, skies, walls, large grounds.

#include "tests/support/report_case.h"

#include "engine/scene/environment.h"
#include "engine/scene/gltf_loader.h"
#include "passes/renderer.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <set>

#include <fmt/format.h>

namespace
{

using std::numbers::pi;

class LightReports : public ReportCase
{
  protected:
    // A spot over a white floor that the picture shows one meter wide: how far it reaches, and E under it.
    void expectSpot(const std::string& name, size_t command)
    {
        const image::Image picture = render(command).picture;
        const double lit = shareOf(picture, [&](uint32_t x, uint32_t y) { return picture.at(x, y).r > 0; });
        expect(name + ": lit radius", std::sqrt(lit / pi));
        double middle = 0;
        const uint32_t half = picture.width / 2;
        for (const uint32_t x : {half - 1, half})
            for (const uint32_t y : {half - 1, half}) middle += double(picture.at(x, y).r) / 4;
        expect(name + ": E at the axis", pi * middle);
    }
};

// Radiance RGBE without runs: 1 in one texel, 0 in all others.
std::string hdrOfOneTexel(uint32_t width, uint32_t height, uint32_t index)
{
    std::string text = fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", height, width);
    for (uint32_t i = 0; i < width * height; ++i)
        text += i == index ? std::string("\x80\x80\x80\x81") : std::string(4, '\0');
    return text;
}

glm::dvec3 rotated(const std::vector<double>& q, const glm::dvec3& v)
{
    const glm::dvec3 u(q[0], q[1], q[2]);
    return v + 2.0 * glm::cross(u, glm::cross(u, v) + q[3] * v);
}

} // namespace

TEST_F(LightReports, TheConeOfASpot)
{
    open("r14_spot_cone");
    expectSpot("spot", 0);
}

TEST_F(LightReports, SpotsOfScaledNodes)
{
    open("r15_spot_scaled");
    size_t command = 0;
    for (const char* name : {"scale3", "scaleneg", "parent", "parent_scaled", "parent_neg"})
        expectSpot(name, command++);
}

TEST_F(LightReports, BodiesInsideOutAndAClosedRoom)
{
    open("r19_inside_out");
    const double outward = meanOf(render(0).picture).r;
    expect("inside out over outward", meanOf(render(1).picture).r / outward);
    size_t command = 2;
    for (const char* method : {"pt", "restir-pt", "rgb-restir", "grouped-restir"})
        expect(fmt::format("room, {}: light through walls", method), largestOf(render(command++).picture));
    expect("room, box filter", largestOf(render(command++).picture));
    expect("room, 64x36", largestOf(render(command++).picture));
}

// A square of side a, one meter above and parallel: E / (pi L) = 4/pi s atan s, s = a/2 / sqrt(1 + a^2/4) (Lambert).
TEST_F(LightReports, EmittersOfManyTriangles)
{
    open("r22_mesh_emitter");
    size_t command = 0;
    for (const double side : {0.1, 1.0, 10.0})
        for (const int triangles : {2, 200}) {
            const double s = side / 2 / std::sqrt(1 + side * side / 4);
            expect(fmt::format("size {}, {} triangles", side, triangles),
                   meanOf(render(command++).picture).r / (4 / pi * s * std::atan(s)));
        }
}

// The picture's middle column is +x, +z lies a quarter to its right, the top row is +y.
TEST_F(LightReports, EveryTexelOfASky)
{
    open("r23_env_texels");
    const image::Image sky = image::read(path("r23_all.hdr")).image;
    const auto skyAt = [&](const glm::dvec3& d) {
        const double u = 0.5 + std::atan2(d.z, d.x) / (2 * pi), v = std::acos(d.y / glm::length(d)) / pi;
        return sky.at(uint32_t(u * sky.width) % sky.width, std::min(uint32_t(v * sky.height), sky.height - 1));
    };
    for (size_t camera = 0; camera < 6; ++camera) {
        const image::Image picture = render(camera).picture;
        const std::string file = path(fmt::format("r23_cam{}.gltf", camera));
        const std::vector<double> rotation = readJson(file)["nodes"][1]["rotation"];
        const auto isRight = [&](uint32_t x, uint32_t y) { // the field is 90 degrees wide and high
            const glm::dvec3 ray(2 * (x + 0.5) / picture.width - 1, 1 - 2 * (y + 0.5) / picture.height, -1);
            const glm::vec3 right = skyAt(rotated(rotation, ray));
            return glm::distance(picture.at(x, y), right) < 1e-5f * glm::length(right);
        };
        expect(fmt::format("camera {}: share of right texels", camera), shareOf(picture, isRight));
    }

    // One texel at a time: the upper ones light the floor, and a mirror shows each at a place of its own. The first by
    // the commands; then all of them in one process, which does not start and compile 64 times.
    gpu::Device device = gpu::Device::create({.adapter = deviceName()});
    std::shared_ptr<passes::PipelinePool> pipelines;
    const auto renderHere = [&](const char* file, uint32_t size, uint32_t frames) {
        scene::Scene scene = scene::loadGltf(path(file), {.sky = false});
        scene::setEnvironment(scene, directory / "r23_one.hdr", 1);
        passes::Settings settings;
        settings.width = settings.height = size;
        settings.maxBounces = 1;
        passes::Renderer renderer(device, scene, settings, {.pipelines = pipelines});
        pipelines = renderer.pipelines();
        for (uint32_t frame = 0; frame < frames; ++frame) renderer.renderFrame();
        for (const auto& [stage, count] : renderer.stats().nonFinite) EXPECT_EQ(count, 0u) << stage;
        return renderer.read(passes::MEAN);
    };
    uint32_t right = 0;
    std::set<std::vector<float>> seen;
    for (uint32_t i = 0; i < sky.width * sky.height; ++i) {
        writeFile(directory / "r23_one.hdr", hdrOfOneTexel(sky.width, sky.height, i));
        const image::Image floor = renderHere("r23_floor.gltf", 16, 256), ball = renderHere("r23_ball.gltf", 48, 1);
        if (i == 0) {
            EXPECT_EQ(render(6).picture.pixels, floor.pixels);
            EXPECT_EQ(render(7).picture.pixels, ball.pixels);
        }
        const uint32_t row = i / sky.width;
        const double top = std::sin(pi * row / sky.height), bottom = std::sin(pi * (row + 1) / sky.height);
        const double irradiance = bottom > top ? pi / sky.width * (bottom * bottom - top * top) : 0;
        right += std::abs(pi * meanOf(floor).r - irradiance) <= 0.01 * irradiance;
        std::vector<float> values;
        for (const glm::vec3& pixel : ball.pixels) values.push_back(pixel.r);
        seen.insert(values);
    }
    expect("floor: texels with irradiance within 1% (lower half 0)", right);
    expect("mirror sphere: different pictures", seen.size());
    expect("values not finite", 0); // render() has looked
}

TEST_F(LightReports, StripsOnABlackSky)
{
    open("n02_studio_nan");
    for (size_t command = 0; command < commandCount(); ++command) {
        const Rendered rendered = render(command);
        uint64_t nonFinite = 0;
        for (const auto& [stage, count] : rendered.stats["nonfinite"].items()) nonFinite += count.get<uint64_t>();
        expect("values not finite", nonFinite);
        expect(command == 0 ? "pt: no warning (262144 walks)" : "rgb-restir: no warning (262144 walks)", rendered.err);
    }
}

TEST_F(LightReports, ASheetCloseAboveALargeGround)
{
    open("n04_huge_ground");
    size_t command = 0;
    for (const char* name : {"ground +-10 m, sheet 0.001 m above", "ground +-1000 m, sheet 0.01 m above",
                             "ground +-1000 m, sheet 0.001 m above", "ground +-10000 m, sheet 0.01 m above"})
        expect(name, meanOf(render(command++, Warns::Yes).picture).r); // that the file has no light
}
