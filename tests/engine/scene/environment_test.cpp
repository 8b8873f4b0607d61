#include "engine/scene/environment.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/base/error.h"

namespace scene
{
namespace
{

image::Image picture(uint32_t width, uint32_t height)
{
    image::Image image{width, height, {}};
    for (uint32_t y = 0, i = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x, ++i) image.pixels.emplace_back(float(i % 7), float(y), 1);
    return image;
}

// Integral of the radiance over the sphere.
glm::dvec3 flux(const Environment& environment)
{
    glm::dvec3 sum(0);
    for (uint32_t y = 0; y < environment.height; ++y) {
        const double step = std::numbers::pi / environment.height;
        const double solidAngle =
            2 * std::numbers::pi / environment.width * (std::cos(y * step) - std::cos((y + 1) * step));
        for (uint32_t x = 0; x < environment.width; ++x)
            sum += solidAngle * glm::dvec3(environment.radiance[y * environment.width + x]);
    }
    return sum;
}

} // namespace

TEST(Environment, MiddleColumnIsPlusXAndPlusZLiesToItsRight)
{
    image::Image image{4, 2, std::vector<glm::vec3>(8, glm::vec3(0))};
    image.at(2, 0) = glm::vec3(1); // begins in the middle: azimuth 0
    image.at(3, 0) = glm::vec3(2); // a quarter to the right: +z
    Warnings warnings;
    const Environment environment = environmentFrom(image, "it", warnings);
    EXPECT_EQ(environment.radiance[0], glm::vec3(1));
    EXPECT_EQ(environment.radiance[1], glm::vec3(2));
    EXPECT_EQ(environment.radiance[4], glm::vec3(0)); // row 1: below the horizon
    EXPECT_TRUE(warnings.sentences().empty());
}

TEST(Environment, ValuesThatAreNoRadianceBecomeZeroAndAreCounted)
{
    image::Image image{3, 1, std::vector<glm::vec3>(3, glm::vec3(5))};
    image.pixels[0] = {std::numeric_limits<float>::quiet_NaN(), -1, 5};
    image.pixels[2].z = std::numeric_limits<float>::infinity();
    Warnings warnings;
    const Environment environment = environmentFrom(image, "It", warnings);
    for (const glm::vec3& texel : environment.radiance) {
        for (int c = 0; c < 3; ++c) EXPECT_TRUE(texel[c] == 0 || texel[c] == 5);
    }
    EXPECT_EQ(warnings.sentences(),
              std::vector<std::string>{"It has 3 values that are negative or not finite: took 0 instead."});
}

TEST(Environment, ReducingKeepsTheFlux)
{
    Warnings warnings;
    const image::Image image = picture(3001, 1499);
    const Environment small = environmentFrom(image, "It", warnings);
    EXPECT_EQ(small.width, 2048u);
    EXPECT_EQ(small.height, 1023u);
    const glm::dvec3 before = flux({image.width, image.height, image.pixels}), after = flux(small);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(after[c] / before[c], 1, 1e-6);
    EXPECT_EQ(warnings.sentences(), std::vector<std::string>{"It is 3001 x 1499 pixels: reduced to 2048 x 1023."});
}

TEST(Environment, FileAndScaleReplaceTheScenesOwn)
{
    const std::filesystem::path file = std::filesystem::temp_directory_path() / "trichrome_environment_test.exr";
    image::write(file, {2, 1, {glm::vec3(1), glm::vec3(3)}}, {});
    Scene scene;
    scene.environment = {1, 1, {glm::vec3(5)}};
    setEnvironment(scene, "", 3);
    EXPECT_EQ(scene.environment.radiance, std::vector<glm::vec3>{glm::vec3(15)});
    setEnvironment(scene, file, 2);
    EXPECT_EQ(scene.environment.radiance, (std::vector<glm::vec3>{glm::vec3(6), glm::vec3(2)}));
    std::filesystem::remove(file);
    EXPECT_THROW(setEnvironment(scene, file, 1), Error);
}

} // namespace scene
