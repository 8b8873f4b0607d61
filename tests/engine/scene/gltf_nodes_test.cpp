#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/tiny_gltf.h"

namespace scene
{
namespace
{

using nlohmann::json;

const double HALF = std::sqrt(0.5);
const json QUARTER_TURN_ABOUT_Y = {0, HALF, 0, HALF}; // takes -z to -x

void expectNear(const glm::dvec3& value, const glm::dvec3& expected)
{
    EXPECT_LT(glm::distance(value, expected), 1e-6) << value.x << ' ' << value.y << ' ' << value.z;
}

json& add(TinyGltf& file, const json& node)
{
    file.json["scenes"][0]["nodes"].push_back(file.json["nodes"].size());
    file.json["nodes"].push_back(node);
    return file.json["nodes"].back();
}

json& addLight(TinyGltf& file, const json& light)
{
    json& lights = file.json["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(light);
    json& node = add(file, json::object());
    node["extensions"]["KHR_lights_punctual"]["light"] = lights.size() - 1;
    return node;
}

} // namespace

TEST(GltfNodes, CamerasOfBothKinds)
{
    TinyGltf file;
    file.json["cameras"] = {
        {{"type", "perspective"},
         {"name", "a"},
         {"perspective", {{"yfov", 0.7}, {"znear", 0.1}, {"aspectRatio", 1.5}}}},
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 3}, {"ymag", 2}, {"znear", 0}, {"zfar", 10}}}}};
    add(file, {{"camera", 0}, {"translation", {5, 0, 0}}, {"rotation", QUARTER_TURN_ABOUT_Y}, {"scale", {2, 3, -4}}});
    add(file, {{"camera", 1}, {"name", "b"}, {"translation", {0, 0, 9}}});
    const Scene scene = file.load();
    ASSERT_EQ(scene.cameras.size(), 2u);

    const Camera& a = scene.cameras[0];
    EXPECT_EQ(a.name, "a");
    EXPECT_FALSE(a.orthographic);
    EXPECT_EQ(a.yfov, 0.7);
    EXPECT_EQ(a.aspect, 1.5);
    expectNear(a.position + scene.origin, {5, 0, 0});
    expectNear(a.up, {0, 1, 0});
    EXPECT_NEAR(std::abs(a.forward.x), 1, 1e-12);
    expectNear(a.right, glm::cross(a.forward, a.up));
    const Camera& b = scene.cameras[1];
    EXPECT_EQ(b.name, "b");
    EXPECT_TRUE(b.orthographic);
    EXPECT_EQ(b.xmag, 3);
    EXPECT_EQ(b.ymag, 2);
    expectNear(b.forward, {0, 0, -1});
    expectNear(b.right, {1, 0, 0});
}

TEST(GltfNodes, WithoutCameraOneSeesTheWholeScene)
{
    TinyGltf file;
    const Scene scene = file.load();
    ASSERT_EQ(scene.cameras.size(), 1u);
    const Camera& camera = scene.cameras[0];
    for (const glm::vec3& position : scene.positions) {
        const glm::dvec3 to = glm::dvec3(position) - camera.position;
        const double depth = glm::dot(to, camera.forward);
        ASSERT_GT(depth, 0);
        const double reach = std::tan(camera.yfov / 2) * depth;
        EXPECT_LE(std::abs(glm::dot(to, camera.up)), reach);
        EXPECT_LE(std::abs(glm::dot(to, camera.right)), reach);
    }
    EXPECT_TRUE(file.warns("The file has no camera: placed one in front that sees the whole scene."));
}

TEST(GltfNodes, LightsOfAllKinds)
{
    TinyGltf file;
    addLight(file, {{"type", "point"}, {"name", "lamp"}, {"color", {1, 0.5, 0}}, {"intensity", 20}})["translation"] = {
        0, 3, 0};
    addLight(file, {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.4}}}})["rotation"] =
        QUARTER_TURN_ABOUT_Y;
    addLight(file, {{"type", "spot"}, {"spot", json::object()}});
    addLight(file, {{"type", "directional"}, {"intensity", 3}})["scale"] = {1, 1, 7};
    const Scene scene = file.load();
    ASSERT_EQ(scene.lights.size(), 4u);

    EXPECT_EQ(scene.lights[0].kind, LightKind::Point);
    EXPECT_EQ(scene.lights[0].name, "lamp");
    EXPECT_EQ(scene.lights[0].intensity, glm::vec3(20, 10, 0));
    expectNear(glm::dvec3(scene.lights[0].position) + scene.origin, {0, 3, 0});
    EXPECT_EQ(scene.lights[1].kind, LightKind::Spot);
    EXPECT_FLOAT_EQ(scene.lights[1].innerConeAngle, 0.2f);
    EXPECT_FLOAT_EQ(scene.lights[1].outerConeAngle, 0.4f);
    expectNear(scene.lights[1].direction, {-1, 0, 0});
    EXPECT_FLOAT_EQ(scene.lights[2].outerConeAngle, float(std::numbers::pi / 4)); // the extension's default
    EXPECT_EQ(scene.lights[2].innerConeAngle, 0);
    EXPECT_EQ(scene.lights[2].intensity, glm::vec3(1));
    EXPECT_EQ(scene.lights[3].kind, LightKind::Directional);
    expectNear(scene.lights[3].direction, {0, 0, -1});
    EXPECT_EQ(scene.environment.width, 0u);
}

// A thousandth of a degree is no mistake.
TEST(GltfNodes, NarrowSpotsAreKept)
{
    TinyGltf file;
    addLight(file, {{"type", "spot"}, {"spot", {{"innerConeAngle", 1e-5}, {"outerConeAngle", 1.75e-5}}}});
    const Scene scene = file.load();
    EXPECT_FLOAT_EQ(scene.lights.at(0).innerConeAngle, 1e-5f);
    EXPECT_FLOAT_EQ(scene.lights.at(0).outerConeAngle, 1.75e-5f);
}

TEST(GltfNodes, WithoutLightThereIsASkyUnlessTheCallerHasOne)
{
    TinyGltf file;
    EXPECT_EQ(file.load().environment.radiance, std::vector<glm::vec3>{glm::vec3(1)});
    EXPECT_TRUE(file.warns("The file has no light: added a uniform sky of radiance 1."));
    EXPECT_EQ(file.load({.sky = false}).environment.width, 0u);
    file.material()["emissiveFactor"] = {0, 1, 0};
    EXPECT_EQ(file.load().environment.width, 0u);
}

TEST(GltfNodes, OnlyTheDefaultSceneIsShown)
{
    TinyGltf file;
    file.json["nodes"] = {{{"mesh", 0}, {"translation", {1, 0, 0}}}, {{"mesh", 0}, {"translation", {2, 0, 0}}}};
    file.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    file.json["scene"] = 1;
    const Scene scene = file.load();
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_NEAR(scene.origin.x, 2.5, 1e-6);
    file.json.erase("scene");
    EXPECT_NEAR(file.load().origin.x, 1.5, 1e-6);
    EXPECT_TRUE(file.warns("The file names no default scene: took the first."));
}

} // namespace scene
