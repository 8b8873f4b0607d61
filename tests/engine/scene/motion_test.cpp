// Poses of small files against closed forms: hierarchies, skins, morph targets, lights, cameras, materials, visibility.
// Covers engine/scene/mesh.cpp.

#include "engine/scene/motion.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "tests/support/tiny_gltf.h"

namespace scene
{
namespace
{

using nlohmann::json;
using std::numbers::pi;

const std::vector<uint32_t> FIRST = {0};
const json TRANSLATION = {{"node", 0}, {"path", "translation"}};
const json SCALE = {{"node", 0}, {"path", "scale"}};
const std::vector<float> NOT_FINITE = {std::nanf(""), INFINITY, -INFINITY};

glm::dvec3 corner(const Scene& scene, size_t triangle, size_t i)
{
    return glm::dvec3(scene.positions[scene.triangles[triangle].vertices[i]]) + scene.origin;
}

glm::dvec3 normal(const Scene& scene, size_t triangle, size_t i)
{
    return glm::dvec3(scene.normals[scene.triangles[triangle].vertices[i]]);
}

void expectNear(const glm::dvec3& value, const glm::dvec3& expected, double tolerance = 1e-6)
{
    EXPECT_LT(glm::distance(value, expected), tolerance)
        << value.x << ' ' << value.y << ' ' << value.z << " instead of " << expected.x << ' ' << expected.y << ' '
        << expected.z;
}

Scene at(const TinyGltf& file, double seconds)
{
    Scene scene = file.load();
    EXPECT_TRUE(scene.motion && scene.motion->animations[0].fault.empty());
    pose(scene, FIRST, seconds);
    return scene;
}

bool vanished(const Triangle& triangle)
{
    return triangle.vertices[0] == triangle.vertices[1] && triangle.vertices[1] == triangle.vertices[2];
}

} // namespace

// A turning parent takes a sliding child along; a sibling does not move and is no part.
TEST(Motion, HierarchiesMoveTogether)
{
    TinyGltf file;
    file.json["nodes"] = {
        {{"children", {1}}, {"translation", {10, 0, 0}}}, {{"mesh", 0}}, {{"mesh", 0}, {"translation", {0, 5, 0}}}};
    file.json["scenes"][0]["nodes"] = {0, 2};
    const float half = float(std::sqrt(0.5));
    file.animate({{"node", 0}, {"path", "rotation"}}, {0, 1}, {0, 0, 0, 1, 0, 0, half, half}, "VEC4");
    file.animate({{"node", 1}, {"path", "translation"}}, {0, 2}, {0, 0, 0, 4, 0, 0}, "VEC3");
    Scene scene = file.load();
    ASSERT_EQ(scene.motion->parts.size(), 1u);
    EXPECT_EQ(scene.motion->nodes.size(), 2u);
    const glm::dvec3 origin = scene.origin, still = corner(scene, 1, 0);
    for (const double t : {0.0, 0.4, 1.0, 1.7}) {
        pose(scene, FIRST, t);
        const double angle = std::min(t, 1.0) * pi / 2, slide = 2 * t;
        const glm::dvec3 along(std::cos(angle), std::sin(angle), 0), across(-std::sin(angle), std::cos(angle), 0);
        const glm::dvec3 start = glm::dvec3(10, 0, 0) + slide * along;
        expectNear(corner(scene, 0, 0), start);
        expectNear(corner(scene, 0, 1), start + along);
        expectNear(corner(scene, 0, 2), start + across);
        EXPECT_EQ(corner(scene, 1, 0), still);
        EXPECT_EQ(scene.origin, origin);
    }
}

// A strip between two joints of which one turns: the middle, half with each, is half way (glTF 2.0, 3.7.3.3). The node
// of the skinned mesh has a transform, which has no effect.
TEST(Motion, SkinsBlendTheirJoints)
{
    TinyGltf file;
    file.attributes()["JOINTS_0"] = file.accessor<uint8_t>({0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC4");
    file.attributes()["WEIGHTS_0"] = file.accessor<float>({1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 2, 0, 0, 0}, "VEC4");
    std::vector<float> inverses(32, 0.0f);
    for (const size_t matrix : {0u, 16u})
        for (const size_t i : {0u, 5u, 10u, 15u}) inverses[matrix + i] = 1;
    inverses[16 + 12] = -3; // the second joint rests at x = 3
    file.json["nodes"] = {
        {{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}}, json::object(), {{"translation", {3, 0, 0}}}};
    file.json["scenes"][0]["nodes"] = {0, 1, 2};
    file.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", file.accessor<float>(inverses, "MAT4")}}};
    const float half = float(std::sqrt(0.5));
    file.animate({{"node", 2}, {"path", "rotation"}}, {0, 1}, {0, 0, 0, 1, half, 0, 0, half}, "VEC4");
    const Scene scene = at(file, 0.5); // 45 degrees about x, through x = 3
    expectNear(corner(scene, 0, 0), {0, 0, 0});
    expectNear(corner(scene, 0, 1), {1, 0, 0}); // on the axis
    const double c = std::sqrt(0.5);
    expectNear(corner(scene, 0, 2), {0, c, c}); // wholly with the second joint; weights of sum 2 count as of sum 1
    expectNear(normal(scene, 0, 0), {0, 0, 1});
    expectNear(normal(scene, 0, 1), glm::normalize(glm::dvec3(0, -c, 1 + c))); // half of each
    expectNear(normal(scene, 0, 2), {0, -c, c});
}

TEST(Motion, MorphTargetsMovePositionsNormalsAndTangents)
{
    TinyGltf file;
    file.material()["normalTexture"]["index"] = file.texture({0, 0, 0, 0});
    file.attributes()["TEXCOORD_0"] = file.accessor<float>({0, 0, 1, 0, 0, 1}, "VEC2");
    file.attributes()["TANGENT"] = file.accessor<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
    const int up = file.accessor<float>({0, 0, 2, 0, 0, 0, 0, 0, 0}, "VEC3");
    const int lean = file.accessor<float>({1, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
    const int sink = file.accessor<float>({0, 0, -1, 0, 0, 0, 0, 0, 0}, "VEC3");
    file.primitive()["targets"] = {{{"POSITION", up}, {"NORMAL", lean}, {"TANGENT", sink}}, {{"POSITION", lean}}};
    file.json["meshes"][0]["weights"] = {0, 1};
    expectNear(corner(file.load(), 0, 0), {1, 0, 0});
    file.animate({{"node", 0}, {"path", "weights"}}, {0, 1}, {0, 0, 1, 0.5f}, "SCALAR");
    Scene scene = at(file, 0.5);
    expectNear(corner(scene, 0, 0), {0.25, 0, 1});
    expectNear(corner(scene, 0, 1), {1, 0, 0});
    expectNear(normal(scene, 0, 0), glm::normalize(glm::dvec3(0.5, 0, 1)));
    const glm::vec4 tangent = scene.tangents[scene.triangles[0].vertices[0]];
    expectNear(glm::dvec3(glm::vec3(tangent)), glm::normalize(glm::dvec3(1, 0, -0.5)));
    EXPECT_EQ(tangent.w, 1);
    pose(scene, {}, 0);
    expectNear(corner(scene, 0, 0), {1, 0, 0}); // the weights of the mesh again
}

// Without normals each triangle is flat, in every pose (3.7.2.1).
TEST(Motion, FlatNormalsFollowTheTriangle)
{
    TinyGltf file;
    file.attributes().erase("NORMAL");
    file.primitive()["targets"] = {{{"POSITION", file.accessor<float>({0, 0, 0, 0, 0, 1, 0, 0, 0}, "VEC3")}}};
    file.animate({{"node", 0}, {"path", "weights"}}, {0, 1}, {0, 1}, "SCALAR");
    const Scene scene = at(file, 1);
    for (size_t i = 0; i < 3; ++i) expectNear(normal(scene, 0, i), glm::normalize(glm::dvec3(-1, 0, 1)));
}

// Scale: an inverse transpose for normals, a turned winding where it mirrors, a point where it is 0; and the same
// triangle throughout.
TEST(Motion, ScalesMayStretchMirrorAndVanish)
{
    TinyGltf file;
    file.json["nodes"][0]["scale"] = {0, 0, 0}; // at rest there is nothing to see
    file.json["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 9}}});
    file.json["scenes"][0]["nodes"] = {0, 1};
    file.animate(SCALE, {0, 1, 2}, {0, 0, 0, 1, 2, 3, -1, 2, 3}, "VEC3");
    Scene scene = file.load();
    ASSERT_EQ(scene.triangles.size(), 2u);
    EXPECT_TRUE(vanished(scene.triangles[0]));
    EXPECT_FALSE(vanished(scene.triangles[1]));
    pose(scene, FIRST, 1);
    expectNear(corner(scene, 0, 2), {0, 2, 0});
    const auto turned = scene.triangles[0].vertices;
    pose(scene, FIRST, 2);
    expectNear(corner(scene, 0, 0), {0, 0, 0});
    EXPECT_EQ(scene.triangles[0].vertices[0], turned[0]);
    EXPECT_EQ(scene.triangles[0].vertices[1], turned[2]); // counter-clockwise again
    EXPECT_EQ(scene.triangles[0].vertices[2], turned[1]);
    expectNear(normal(scene, 0, 0), {0, 0, 1});
    pose(scene, FIRST, 1.5); // through a plane
    EXPECT_TRUE(vanished(scene.triangles[0]));
    for (const glm::vec3& n : scene.normals) EXPECT_NEAR(glm::length(n), 1, 1e-6);
    pose(scene, FIRST, 1);
    EXPECT_EQ(scene.triangles[0].vertices, turned);
}

TEST(Motion, CamerasAndLightsRideOnNodes)
{
    TinyGltf file;
    file.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"intensity", 7}, {"color", {1, 0.5, 0}}, {"spot", json::object()}}};
    file.json["nodes"].push_back({{"children", {2, 3}}});
    file.json["nodes"].push_back({{"camera", 0}, {"translation", {0, 0, 5}}});
    file.json["nodes"].push_back(
        {{"translation", {0, 1, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.json["scenes"][0]["nodes"] = {0, 1};
    const float half = float(std::sqrt(0.5));
    file.animate({{"node", 1}, {"path", "rotation"}}, {0, 1}, {0, 0, 0, 1, 0, half, 0, half}, "VEC4");
    const Scene scene = at(file, 1); // a quarter turn about y takes +z to +x
    const Camera& camera = scene.cameras[0];
    expectNear(camera.position + scene.origin, {5, 0, 0});
    expectNear(camera.forward, {-1, 0, 0});
    expectNear(camera.right, {0, 0, -1});
    expectNear(camera.up, {0, 1, 0});
    EXPECT_EQ(camera.yfov, 0.7);
    const double ahead = glm::dot(camera.target - camera.position, camera.forward);
    EXPECT_NEAR(ahead, glm::dot(-camera.position, camera.forward), 1e-9);
    const PunctualLight& light = scene.lights[0];
    expectNear(glm::dvec3(light.position) + scene.origin, {0, 1, 0});
    expectNear(light.direction, {-1, 0, 0});
    EXPECT_EQ(light.intensity, glm::vec3(7, 3.5f, 0));
    EXPECT_TRUE(scene.motion->parts.empty());
}

TEST(Motion, WithoutADirectionLightsAreOutAndCamerasStay)
{
    TinyGltf file;
    file.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}, {"intensity", 7}}};
    file.json["nodes"].push_back({{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.json["scenes"][0]["nodes"] = {0, 1};
    file.animate({{"node", 1}, {"path", "scale"}}, {0, 1}, {1, 1, 1, 0, 0, 0}, "VEC3");
    Scene scene = file.load();
    const glm::dvec3 place = scene.cameras[0].position;
    for (const double t : {1.0, 0.5, 1.0, 0.0}) {
        pose(scene, FIRST, t);
        EXPECT_EQ(scene.lights[0].intensity, glm::vec3(t == 1 ? 0 : 7));
        EXPECT_EQ(scene.lights[0].direction, glm::vec3(0, 0, -1));
        EXPECT_EQ(scene.cameras[0].position, place);
        expectNear(scene.cameras[0].forward, {0, 0, -1});
    }
}

// KHR_animation_pointer.
TEST(Motion, PointersMoveLightsCamerasAndMaterials)
{
    TinyGltf file;
    file.material() = {{"emissiveFactor", {1, 0.5, 0}},
                       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}}};
    file.json["materials"].push_back(json::object()); // of no triangle
    file.json["cameras"] = {
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}}};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"intensity", 8}, {"spot", json::object()}}};
    file.json["nodes"].push_back({{"camera", 0}, {"translation", {0, 0, 5}}});
    file.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.json["scenes"][0]["nodes"] = {0, 1, 2, 3};
    const std::string light = "/extensions/KHR_lights_punctual/lights/0/";
    file.animatePointer(light + "intensity", {0, 1}, {8, 24}, "SCALAR");
    file.animatePointer(light + "color", {0, 1}, {1, 1, 1, 0, 1, 2}, "VEC3");
    file.animatePointer(light + "spot/innerConeAngle", {0, 1}, {0, 0.2f}, "SCALAR");
    file.animatePointer(light + "spot/outerConeAngle", {0, 1}, {0.4f, 0.8f}, "SCALAR");
    file.animatePointer("/cameras/0/orthographic/ymag", {0, 1}, {2, 4}, "SCALAR");
    file.animatePointer("/materials/0/pbrMetallicRoughness/baseColorFactor", {0, 1}, {1, 1, 1, 1, 0, 0.5f, 3, 1},
                        "VEC4");
    file.animatePointer("/materials/0/pbrMetallicRoughness/roughnessFactor", {0, 1}, {1, 0}, "SCALAR");
    file.animatePointer("/materials/0/emissiveFactor", {0, 1}, {1, 0, 0, 0, 1, 0}, "VEC3");
    file.animatePointer("/materials/1/emissiveFactor", {0, 1}, {1, 0, 0, 0, 1, 0}, "VEC3");
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_animation_pointer"};
    Scene scene = at(file, 0.5);
    for (const size_t i : {0u, 1u}) expectNear(scene.lights[i].intensity, {8, 16, 24});
    EXPECT_NEAR(scene.lights[0].innerConeAngle, 0.1, 1e-6);
    EXPECT_NEAR(scene.lights[0].outerConeAngle, 0.6, 1e-6);
    EXPECT_NEAR(scene.cameras[0].ymag, 3, 1e-6);
    EXPECT_EQ(scene.cameras[0].xmag, 1);
    const Material& material = scene.materials[0];
    expectNear(glm::vec3(material.baseColor), {0.5, 0.75, 1}); // held in its range
    EXPECT_EQ(material.roughness, 0.5f);
    expectNear(material.emission, {2, 2, 0}); // of strength 4
    EXPECT_EQ(scene.motion->animations[0].channels.size(), 8u);
    pose(scene, {}, 0);
    expectNear(scene.lights[0].intensity, {8, 8, 8});
    expectNear(scene.materials[0].emission, {4, 2, 0});
    EXPECT_EQ(scene.materials[0].roughness, 1);
}

// What begins dark is no reason for a sky.
TEST(Motion, EmissionThatWillComeIsLight)
{
    TinyGltf file;
    file.material()["emissiveFactor"] = {0, 0, 0};
    file.animatePointer("/materials/0/emissiveFactor", {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3");
    EXPECT_EQ(file.load().environment.width, 0u);
    expectNear(at(file, 1).materials[0].emission, {1, 1, 1});
}

TEST(Motion, VisibilityIsInheritedAndCanChange)
{
    const auto visible = [](bool is) { return json{{"KHR_node_visibility", {{"visible", is}}}}; };
    TinyGltf file;
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 8}}};
    file.json["nodes"] = {{{"children", {1, 2}}, {"extensions", visible(false)}},
                          {{"mesh", 0}},
                          {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
                          {{"mesh", 0}, {"translation", {0, 3, 0}}}};
    file.json["scenes"][0]["nodes"] = {0, 3};
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_node_visibility"};
    EXPECT_EQ(file.load().triangles.size(), 1u); // for good
    EXPECT_TRUE(file.load().lights.empty());

    file.animatePointer("/nodes/0/extensions/KHR_node_visibility/visible", {0, 1}, {0, 1}, "SCALAR", "STEP");
    Scene scene = file.load();
    ASSERT_EQ(scene.triangles.size(), 2u);
    EXPECT_TRUE(vanished(scene.triangles[0]));
    EXPECT_EQ(scene.lights.at(0).intensity, glm::vec3(0));
    pose(scene, FIRST, 1);
    EXPECT_FALSE(vanished(scene.triangles[0]));
    EXPECT_EQ(scene.lights[0].intensity, glm::vec3(8));
    pose(scene, FIRST, 0.99);
    EXPECT_TRUE(vanished(scene.triangles[0]));
    EXPECT_EQ(scene.lights[0].intensity, glm::vec3(0));
    EXPECT_FALSE(vanished(scene.triangles[1]));
}

// Instances of one mesh are stored once; each has its own vertices in the flat scene.
TEST(Motion, InstancesShareTheirMesh)
{
    TinyGltf file;
    const int places = file.accessor<float>({0, 0, 0, 5, 0, 0, 0, 7, 0}, "VEC3");
    file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
    file.json["nodes"].push_back({{"mesh", 0}});
    file.json["scenes"][0]["nodes"] = {0, 1};
    file.animate(TRANSLATION, {0, 1}, {0, 0, 0, 0, 0, 2}, "VEC3");
    file.animate({{"node", 1}, {"path", "translation"}}, {0, 1}, {0, 0, 0, 0, 0, 4}, "VEC3");
    const Scene scene = at(file, 1);
    EXPECT_EQ(scene.motion->parts.size(), 4u);
    EXPECT_EQ(scene.motion->meshes.size(), 1u);
    expectNear(corner(scene, 1, 0), {5, 0, 2});
    expectNear(corner(scene, 2, 0), {0, 7, 2});
    expectNear(corner(scene, 3, 0), {0, 0, 4});
}

// A static triangle without area is dropped as ever, and the parts behind it still know where they are.
TEST(Motion, PartsBehindDroppedTrianglesKeepTheirPlace)
{
    TinyGltf file;
    file.json["nodes"] = {{{"mesh", 0}, {"scale", {0, 1, 1}}}, {{"mesh", 0}}, {{"mesh", 0}, {"scale", {1, 0, 1}}}};
    file.json["scenes"][0]["nodes"] = {0, 1, 2};
    file.animate({{"node", 1}, {"path", "translation"}}, {0, 1}, {0, 0, 0, 0, 0, 2}, "VEC3");
    const Scene scene = at(file, 1);
    ASSERT_EQ(scene.triangles.size(), 1u);
    EXPECT_EQ(scene.motion->parts.at(0).firstTriangle, 0u);
    expectNear(corner(scene, 0, 1), {1, 0, 2});
    EXPECT_TRUE(file.warns("Dropped a triangle without area (2 times)."));
}

TEST(Motion, TooFarAwayIsRefusedInOneSentence)
{
    TinyGltf file;
    file.animate(TRANSLATION, {0, 1, 2}, {0, 0, 0, 3e9f, 0, 0, 3e38f, 3e38f, 3e38f}, "VEC3");
    Scene scene = file.load();
    for (const double t : {1.0, 2.0}) {
        try {
            pose(scene, FIRST, t);
            ADD_FAILURE() << "posed";
        } catch (const Error& error) {
            EXPECT_EQ(error.what(),
                      fmt::format("At {} s, vertex 0 of meshes[0].primitives[0] at nodes[0] is more than "
                                  "500000000 m from the middle of the scene or not finite: choose another "
                                  "time or animation.",
                                  t));
        }
    }
    pose(scene, {}, 0); // and the scene is none the worse
    expectNear(corner(scene, 0, 0), {0, 0, 0});
}

// What is not finite in the file is left out for good, and does not make a pose impossible.
TEST(Motion, TrianglesThatAreNotFiniteAreLeftOutForGood)
{
    for (const float bad : NOT_FINITE) {
        TinyGltf file;
        file.attributes() = {
            {"POSITION", file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, bad, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3")}};
        file.animate(TRANSLATION, {0, 1}, {0, 0, 0, 0, 0, 2}, "VEC3");
        const Scene scene = at(file, 1);
        ASSERT_EQ(scene.triangles.size(), 1u);
        expectNear(corner(scene, 0, 1), {1, 0, 2});
        for (const glm::vec3& position : scene.positions) EXPECT_TRUE(std::isfinite(position.x));
        EXPECT_TRUE(file.warns("Dropped a triangle with a vertex that is not finite."));
    }
}

// Where it is what places them that is not finite, the file is shown at rest as it is without its animations.
TEST(Motion, TrianglesThatAreNotFiniteAtRestArePointsThere)
{
    for (const float bad : NOT_FINITE) {
        for (size_t axis = 0; axis < 3; ++axis) {
            TinyGltf file;
            std::vector<float> places(6, 0.0f);
            places[3 + axis] = bad;
            file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
                file.accessor<float>(places, "VEC3");
            const Scene still = file.load();
            file.animate(TRANSLATION, {0, 1}, {0, 0, 0, 0, 0, 2}, "VEC3");
            EXPECT_EQ(file.error(), "");
            Scene scene = file.load();
            EXPECT_EQ(scene.warnings, still.warnings);
            EXPECT_TRUE(file.warns("Dropped a triangle with a vertex that is not finite."));
            ASSERT_EQ(still.triangles.size(), 1u);
            ASSERT_EQ(scene.triangles.size(), 2u);
            EXPECT_EQ(scene.origin, still.origin);
            for (size_t i = 0; i < 3; ++i) EXPECT_EQ(corner(scene, 0, i), corner(still, 0, i));
            EXPECT_TRUE(vanished(scene.triangles[1]));
            for (const glm::vec3& position : scene.positions) EXPECT_LT(glm::length(position), 2);
            EXPECT_THROW(pose(scene, FIRST, 1), Error); // in motion it is an error as ever
        }
    }
}

// A joint that is not finite takes one corner of one triangle of two: the other keeps its normals and tangents. When
// nothing else is left, there is an empty scene.
TEST(Motion, ABrokenJointLeavesTheOtherTrianglesAsTheyAre)
{
    TinyGltf file;
    file.material()["normalTexture"]["index"] = file.texture({0, 0, 0, 0});
    file.attributes() = {{"POSITION", file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 5, 0}, "VEC3")},
                         {"NORMAL", file.accessor<float>(std::vector<float>(12, 0.0f), "VEC3")},
                         {"TEXCOORD_0", file.accessor<float>({0, 1, 0, 0, 1, 1, -1, 1}, "VEC2")},
                         {"JOINTS_0", file.accessor<uint8_t>({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0}, "VEC4")},
                         {"WEIGHTS_0", file.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4")}};
    file.primitive()["indices"] = file.accessor<uint16_t>({0, 1, 2, 0, 3, 1}, "SCALAR");
    std::vector<float> inverses(32, 0.0f);
    for (size_t i = 0; i < 32; i += i % 16 == 15 ? 1 : 5) inverses[i] = 1;
    inverses[16 + 13] = INFINITY; // joint 1 lifts without end
    file.json["nodes"] = {{{"mesh", 0}, {"skin", 0}}, json::object(), json::object()};
    file.json["scenes"][0]["nodes"] = {0, 1, 2};
    file.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", file.accessor<float>(inverses, "MAT4")}}};
    const Scene still = file.load();
    file.animate({{"node", 1}, {"path", "translation"}}, {0, 1}, {0, 0, 0, 0, 0, 2}, "VEC3");
    EXPECT_EQ(file.error(), "");
    const Scene scene = file.load();
    ASSERT_EQ(still.triangles.size(), 1u);
    ASSERT_EQ(scene.triangles.size(), 2u);
    EXPECT_EQ(scene.warnings, still.warnings);
    EXPECT_EQ(scene.origin, still.origin);
    for (size_t i = 0; i < 3; ++i) {
        const uint32_t v = scene.triangles[0].vertices[i], sameStill = still.triangles[0].vertices[i];
        EXPECT_EQ(scene.positions[v], still.positions[sameStill]);
        EXPECT_EQ(scene.normals[v], still.normals[sameStill]);
        EXPECT_EQ(scene.tangents[v], still.tangents[sameStill]);
        expectNear(normal(scene, 0, i), {0, 1, 0});
    }
    EXPECT_TRUE(vanished(scene.triangles[1]));

    file.primitive()["indices"] = file.accessor<uint16_t>({0, 3, 1}, "SCALAR");
    const Scene nothing = file.load();
    EXPECT_EQ(nothing.origin, glm::dvec3(0));
    EXPECT_TRUE(vanished(nothing.triangles.at(0)));
}

// Generated tangents: vertices on a mirror seam are doubled once, and follow the mesh in all poses.
TEST(Motion, MirrorSeamsAreSplitOnceForAllPoses)
{
    TinyGltf file;
    file.material()["normalTexture"]["index"] = file.texture({0, 0, 0, 0});
    // Two triangles that share an edge, across which the texture is mirrored.
    file.attributes() = {{"POSITION", file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0}, "VEC3")},
                         {"NORMAL", file.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")},
                         {"TEXCOORD_0", file.accessor<float>({0, 1, 1, 1, 0, 0, 1, 1}, "VEC2")}};
    file.primitive()["indices"] = file.accessor<uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
    const Scene still = file.load();
    EXPECT_EQ(still.positions.size(), 6u);
    const float half = float(std::sqrt(0.5));
    file.animate({{"node", 0}, {"path", "rotation"}}, {0, 1}, {0, 0, 0, 1, 0, 0, half, half}, "VEC4");
    Scene scene = file.load();
    EXPECT_EQ(scene.positions, still.positions);
    EXPECT_EQ(scene.tangents, still.tangents);
    pose(scene, FIRST, 1);
    ASSERT_EQ(scene.tangents.size(), still.tangents.size());
    for (size_t v = 0; v < still.tangents.size(); ++v) {
        const glm::vec4 &before = still.tangents[v], &after = scene.tangents[v];
        expectNear({after.x, after.y, after.z}, {-before.y, before.x, before.z});
        EXPECT_EQ(after.w, before.w);
    }
}

} // namespace scene
