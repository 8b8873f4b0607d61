// Two drivers of different makers, lavapipe and SwiftShader, make the same picture of every built-in scene with every
// method. Runs have equal seeds on both, and differences of their tiles are tested: what is left is rounding, and the
// few paths on which rounding decides a branch. By default two of these cases, all with TRICHROME_TEST_DRIVERS=1
// (ctest -R drivers); with TRICHROME_TEST_DRIVERS=ICD.json all of them on that driver in SwiftShader's place.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "engine/scene/procedural.h"
#include "passes/camera_path.h"
#include "passes/renderer.h"
#include "tests/support/tile_tests.h"

namespace support
{
namespace
{

using passes::Method;

constexpr const char* LAVAPIPE = "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json";
constexpr const char* SWIFTSHADER = "/usr/lib/chromium/vk_swiftshader_icd.json";
constexpr size_t DRIVERS = 2;
constexpr uint32_t RUNS = 24;

struct Driver {
    gpu::Device device;
    std::shared_ptr<passes::PipelinePool> pipelines;

    explicit Driver(const std::string& name)
        : device(gpu::Device::create({.adapter = name})), pipelines(std::make_shared<passes::PipelinePool>(device))
    {
    }
};

class DriversAgreement : public testing::TestWithParam<std::tuple<scene::BuiltInScene, Method>>
{
  protected:
    void SetUp() override
    {
        const char* asked = std::getenv("TRICHROME_TEST_DRIVERS");
        const std::string scene = std::get<0>(GetParam()).name;
        const Method method = std::get<1>(GetParam());
        const bool usual = scene == "cornell" && (method == Method::RgbRestir || method == Method::Pt);
        if (!asked && !usual) GTEST_SKIP() << "SKIPPED, NOT TESTED: takes minutes; ctest -L bench -R drivers does it";
        const std::string other = asked == nullptr || std::string(asked) == "1" ? SWIFTSHADER : asked;
        for (const std::string& driver : {std::string(LAVAPIPE), other})
            if (!std::filesystem::exists(driver)) GTEST_SKIP() << "SKIPPED, NOT TESTED: there is no " << driver;
        setenv("VK_ICD_FILENAMES", fmt::format("{}:{}", LAVAPIPE, other).c_str(), 1);
        for (size_t i = 0; i < DRIVERS; ++i)
            if (!drivers_[i]) drivers_[i] = std::make_unique<Driver>(std::to_string(i));
        ASSERT_NE(drivers_[0]->device.adapter().driver, drivers_[1]->device.adapter().driver);
    }
    static void TearDownTestSuite()
    {
        for (std::unique_ptr<Driver>& driver : drivers_) driver.reset();
    }

    static std::unique_ptr<Driver> drivers_[DRIVERS]; // in the loader's order
};
std::unique_ptr<Driver> DriversAgreement::drivers_[DRIVERS];

// The last of 3 frames with a moving camera, so that all stages take part; one picture for each seed.
std::vector<image::Image> picturesOn(Driver& driver, const scene::Scene& scene, Method method)
{
    passes::Settings settings;
    settings.method = method;
    settings.width = 24;
    settings.height = 16;
    settings.maxBounces = 3;
    settings.spatial = 1;
    passes::Renderer renderer(driver.device, scene, settings, {.pipelines = driver.pipelines});
    const passes::CameraAt cameraAt = passes::cameraOrbit(scene.cameras.at(0), 2);
    std::vector<image::Image> pictures;
    for (settings.seed = 0; settings.seed < RUNS; ++settings.seed) {
        renderer.setCamera(cameraAt(0));
        renderer.apply(settings);
        renderer.reset();
        for (uint32_t frame = 0; frame < 3; ++frame) {
            renderer.setCamera(cameraAt(frame));
            renderer.renderFrame();
        }
        pictures.push_back(renderer.read(passes::LAST_FRAME));
        for (const auto& [stage, count] : renderer.stats().nonFinite)
            EXPECT_EQ(count, 0u) << driver.device.adapter().driver << " " << stage;
    }
    return pictures;
}

TEST_P(DriversAgreement, OnTheMeanOfEveryTile)
{
    const scene::Scene scene = std::get<0>(GetParam()).make();
    const std::vector<image::Image> a = picturesOn(*drivers_[0], scene, std::get<1>(GetParam()));
    const std::vector<image::Image> b = picturesOn(*drivers_[1], scene, std::get<1>(GetParam()));

    PictureRuns difference, one;
    uint64_t equal = 0;
    for (uint32_t run = 0; run < RUNS; ++run) {
        image::Image picture = a[run];
        for (size_t i = 0; i < picture.pixels.size(); ++i) {
            const glm::vec3 x = a[run].pixels[i], y = b[run].pixels[i];
            equal += glm::length(x - y) <= 1e-3f * glm::length(x) ? 1 : 0;
            picture.pixels[i] = x - y;
        }
        difference.add(picture);
        one.add(a[run]);
    }
    const double share = double(equal) / double(RUNS * a[0].pixels.size());

    // Zero, but for rounding: 1e-4 of the tile.
    const auto zero = [](TileEstimates tiles) {
        for (auto& tile : tiles.tiles)
            for (Estimate& e : tile) e = {0, std::pow(1e-4 * e.mean, 2), std::numeric_limits<double>::infinity()};
        return tiles;
    };
    const PictureEstimates found = difference.estimates(), mean = one.estimates();
    const TileVerdict verdict = tilesAgree(found.tiles, zero(mean.tiles));
    EXPECT_TRUE(verdict.passes) << verdict.summary;
    double worst = 0;
    for (size_t c = 0; c < 3; ++c) {
        const Estimate& whole = found.whole.tiles[0][c];
        const double scale = mean.whole.tiles[0][c].mean;
        worst = std::max(worst, std::abs(whole.mean) / scale);
        const statistics::Difference d = statistics::compare(whole, zero(mean.whole).tiles[0][c]);
        EXPECT_TRUE(showsEquivalence(d, 0.01 * scale, 0.05))
            << "channel " << c << ": differs by " << whole.mean << " of " << scale;
    }
    EXPECT_GT(share, 0.9);
    std::printf("%.2f%% of pixels are equal within 1e-3, means within %.1e; %s\n", 100 * share, worst,
                verdict.summary.c_str());
}

constexpr Method METHODS[] = {Method::Pt, Method::RestirPt, Method::RgbRestir, Method::GroupedRestir};
constexpr const char* METHOD_NAMES[] = {"Pt", "RestirPt", "RgbRestir", "GroupedRestir"};

std::string nameOf(const testing::TestParamInfo<DriversAgreement::ParamType>& test)
{
    return std::string(std::get<0>(test.param).name) + METHOD_NAMES[size_t(std::get<1>(test.param))];
}

INSTANTIATE_TEST_SUITE_P(Of, DriversAgreement,
                         testing::Combine(testing::ValuesIn(scene::builtInScenes()), testing::ValuesIn(METHODS)),
                         nameOf);

} // namespace
} // namespace support
