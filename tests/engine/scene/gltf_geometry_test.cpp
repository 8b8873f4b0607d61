// Covers engine/scene/gltf_accessor.cpp, engine/scene/gltf_mesh_part.cpp, engine/scene/mesh_tangents.cpp.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/tiny_gltf.h"

namespace scene
{
namespace
{

using nlohmann::json;

glm::dvec3 world(const Scene& scene, uint32_t vertex)
{
    return glm::dvec3(scene.positions[vertex]) + scene.origin;
}

glm::dvec3 corner(const Scene& scene, size_t triangle, size_t i)
{
    return world(scene, scene.triangles[triangle].vertices[i]);
}

glm::dvec3 geometricNormal(const Scene& scene, size_t triangle)
{
    const glm::dvec3 a = corner(scene, triangle, 0);
    return glm::normalize(glm::cross(corner(scene, triangle, 1) - a, corner(scene, triangle, 2) - a));
}

void expectNear(const glm::dvec3& value, const glm::dvec3& expected, double tolerance = 1e-6)
{
    EXPECT_LT(glm::distance(value, expected), tolerance)
        << value.x << ' ' << value.y << ' ' << value.z << " instead of " << expected.x << ' ' << expected.y << ' '
        << expected.z;
}

// The base triangle after `node` has been given these members.
Scene withNode(const json& members)
{
    TinyGltf file;
    file.json["nodes"][0].update(members);
    return file.load();
}

template <class Index>
class GltfIndices : public testing::Test
{
};
using IndexTypes = testing::Types<uint8_t, uint16_t, uint32_t>;
TYPED_TEST_SUITE(GltfIndices, IndexTypes);

TYPED_TEST(GltfIndices, OfEveryTypePickVertices)
{
    TinyGltf file;
    file.attributes() = {{"POSITION", file.accessor<float>({9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 2, 0, 3, 0, 0}, "VEC3")}};
    file.primitive()["indices"] = file.accessor<TypeParam>({1, 4, 3, 1, 2, 3}, "SCALAR");
    const Scene scene = file.load();
    ASSERT_EQ(scene.triangles.size(), 2u);
    expectNear(corner(scene, 0, 1), {3, 0, 0});
    expectNear(corner(scene, 1, 1), {1, 0, 0});
    expectNear(corner(scene, 1, 2), {0, 2, 0});
}

} // namespace

TEST(GltfGeometry, AttributesOfEveryComponentType)
{
    TinyGltf file;
    const int colors = file.accessor<uint16_t>({65535, 0, 0, 65535, 0, 13107, 0, 0, 0, 0, 65535, 65535}, "VEC4", true);
    const std::vector<std::pair<int, glm::vec2>> uvs = {
        {file.accessor<float>({0.25f, 2, 0, 0, 0, 0}, "VEC2"), {0.25f, 2}},
        {file.accessor<uint8_t>({51, 255, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC2", true), {0.2f, 1}},
        {file.accessor<uint16_t>({13107, 65535, 0, 0, 0, 0}, "VEC2", true), {0.2f, 1}}};
    file.json["bufferViews"][file.json["accessors"][size_t(uvs[1].first)]["bufferView"].get<size_t>()]["byteStride"] =
        4;
    file.json["accessors"][size_t(uvs[1].first)]["count"] = 3;
    file.attributes()["COLOR_0"] = colors;
    file.material()["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", file.texture({0, 0, 0, 0})}};
    for (const auto& [accessor, first] : uvs) {
        file.attributes()["TEXCOORD_0"] = accessor;
        const Scene scene = file.load();
        ASSERT_EQ(scene.uv0.size(), 3u);
        EXPECT_LT(glm::distance(scene.uv0[0], first), 1e-5f);
        EXPECT_TRUE(scene.uv1.empty());
        EXPECT_LT(glm::distance(scene.colors[1], glm::vec4(0, 0.2f, 0, 0)), 1e-5f);
    }
    file.attributes()["COLOR_0"] = file.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0.5f, 1}, "VEC3");
    EXPECT_EQ(file.load().colors[2], glm::vec4(0, 0.5f, 1, 1)); // RGB: opaque
}

TEST(GltfGeometry, QuantizedPositions)
{
    TinyGltf file;
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    file.attributes() = {{"POSITION", file.accessor<int16_t>({-5, 0, 0, 0, 7, 0, 0, 0, 0, 300, 0, 0}, "VEC3")}};
    const int accessor = file.attributes()["POSITION"];
    file.json["bufferViews"].back()["byteStride"] = 8; // three values and two bytes of padding
    file.json["accessors"][size_t(accessor)]["count"] = 3;
    expectNear(corner(file.load(), 0, 0), {-5, 0, 0});
    expectNear(corner(file.load(), 0, 1), {7, 0, 0});
    file.json["accessors"][size_t(accessor)]["normalized"] = true;
    expectNear(corner(file.load(), 0, 1), {7 / 32767.0, 0, 0});
}

TEST(GltfGeometry, SparseAccessorsWithAndWithoutABase)
{
    for (const bool based : {true, false}) {
        TinyGltf file;
        json& accessor = file.json["accessors"][0];
        accessor["sparse"] = {{"count", 2},
                              {"indices", {{"bufferView", file.view<uint16_t>({1, 2})}, {"componentType", 5123}}},
                              {"values", {{"bufferView", file.view<float>({5, 0, 0, 0, 6, 0})}}}};
        if (!based) file.json["accessors"][0].erase("bufferView");
        const Scene scene = file.load();
        expectNear(corner(scene, 0, 0), {0, 0, 0});
        expectNear(corner(scene, 0, 1), {5, 0, 0});
        expectNear(corner(scene, 0, 2), {0, 6, 0});
    }
}

TEST(GltfGeometry, InterleavedAttributes)
{
    TinyGltf file;
    const int view = file.view<float>({0, 0, 0, 0, 1, 0, 2, 0, 0, 0, 1, 0, 0, 0, -2, 0, 1, 0});
    file.json["bufferViews"][size_t(view)]["byteStride"] = 24;
    for (const char* name : {"POSITION", "NORMAL"}) {
        file.attributes()[name] = file.json["accessors"].size();
        file.json["accessors"].push_back({{"bufferView", view},
                                          {"byteOffset", name == std::string("NORMAL") ? 12 : 0},
                                          {"componentType", 5126},
                                          {"count", 3},
                                          {"type", "VEC3"}});
    }
    const Scene scene = file.load();
    expectNear(corner(scene, 0, 1), {2, 0, 0});
    expectNear(corner(scene, 0, 2), {0, 0, -2});
    expectNear(scene.normals[scene.triangles[0].vertices[2]], {0, 1, 0});
}

TEST(GltfGeometry, StripsAndFansKeepTheWinding)
{
    TinyGltf file;
    const std::vector<float> strip = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    const std::vector<float> fan = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    for (const auto& [mode, positions] : {std::pair(5, strip), std::pair(6, fan)}) {
        file.attributes() = {{"POSITION", file.accessor<float>(positions, "VEC3")}};
        file.primitive()["mode"] = mode;
        const Scene scene = file.load();
        ASSERT_EQ(scene.triangles.size(), 2u);
        for (size_t i = 0; i < 2; ++i) expectNear(geometricNormal(scene, i), {0, 0, 1});
    }
    for (const int mode : {0, 1, 2, 3}) { // points and lines
        file.primitive()["mode"] = mode;
        EXPECT_TRUE(file.load().triangles.empty());
    }
}

TEST(GltfGeometry, MirroringScalesTurnTheWindingNotTheNormal)
{
    for (const json& scale : {json{-1, 1, 1}, json{1, -2, 1}, json{-1, -1, -1}}) {
        const Scene scene = withNode({{"scale", scale}});
        const glm::dvec3 normal = scene.normals[scene.triangles[0].vertices[0]];
        expectNear(normal, {0, 0, scale[2].get<double>() < 0 ? -1 : 1});
        expectNear(geometricNormal(scene, 0), normal);
    }
}

TEST(GltfGeometry, NonUniformScalesTransformNormalsAsPlanes)
{
    TinyGltf file;
    file.attributes()["POSITION"] = file.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
    const float s = 1 / std::sqrt(3.0f);
    file.attributes()["NORMAL"] = file.accessor<float>({s, s, s, s, s, s, s, s, s}, "VEC3");
    file.json["nodes"][0]["scale"] = {1, 2, -4};
    const Scene scene = file.load();
    const glm::dvec3 expected = glm::normalize(glm::dvec3(1, 0.5, -0.25));
    expectNear(scene.normals[scene.triangles[0].vertices[1]], expected);
    expectNear(geometricNormal(scene, 0), expected);
}

TEST(GltfGeometry, HierarchiesComposeTranslationRotationAndScale)
{
    TinyGltf file;
    const double half = std::sqrt(0.5);
    file.json["nodes"] = {
        {{"children", {1}}, {"translation", {10, 0, 0}}, {"rotation", {0, 0, half, half}}}, // 90 degrees
        {{"children", {2}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 5, 0, 1}}},
        {{"mesh", 0}, {"scale", {2, 3, 1}}}};
    const Scene scene = file.load();
    expectNear(corner(scene, 0, 0), {5, 0, 0});
    expectNear(corner(scene, 0, 1), {5, 2, 0});
    expectNear(corner(scene, 0, 2), {2, 0, 0});
}

TEST(GltfGeometry, InstancesSkinsAndMorphTargets)
{
    TinyGltf instanced;
    instanced.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", instanced.accessor<float>({0, 0, 0, 0, 0, 5}, "VEC3")},
        {"SCALE", instanced.accessor<float>({1, 1, 1, 2, 2, 2}, "VEC3")}};
    const Scene two = instanced.load();
    ASSERT_EQ(two.triangles.size(), 2u);
    expectNear(corner(two, 1, 1), {2, 0, 5});

    TinyGltf skinned;
    skinned.attributes()["JOINTS_0"] = skinned.accessor<uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4");
    skinned.attributes()["WEIGHTS_0"] = skinned.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}, "VEC4");
    skinned.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}}, // has no effect on a skin
                             {{"translation", {0, 0, 1}}},
                             {{"translation", {0, 0, 3}}}};
    skinned.json["scenes"][0]["nodes"] = {0, 1, 2};
    skinned.json["skins"] = {{{"joints", {1, 2}}}};
    const Scene bent = skinned.load();
    expectNear(corner(bent, 0, 0), {0, 0, 1});
    expectNear(corner(bent, 0, 1), {1, 0, 3});
    expectNear(corner(bent, 0, 2), {0, 1, 2});

    TinyGltf morphed;
    morphed.primitive()["targets"] = {{{"POSITION", morphed.accessor<float>({0, 0, 2, 0, 0, 0, 0, 0, 0}, "VEC3")}}};
    morphed.json["meshes"][0]["weights"] = {0.5};
    expectNear(corner(morphed.load(), 0, 0), {0, 0, 1});
    morphed.json["nodes"][0]["weights"] = {1}; // of the node: they win
    expectNear(corner(morphed.load(), 0, 0), {0, 0, 2});
}

TEST(GltfGeometry, MissingNormalsAreFlat)
{
    TinyGltf file;
    file.attributes() = {{"POSITION", file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3")}};
    file.primitive()["indices"] = file.accessor<uint8_t>({0, 1, 2, 0, 3, 1}, "SCALAR");
    const Scene scene = file.load();
    for (size_t triangle = 0; triangle < 2; ++triangle)
        for (const uint32_t vertex : scene.triangles[triangle].vertices)
            expectNear(scene.normals[vertex], geometricNormal(scene, triangle));
}

TEST(GltfGeometry, FarScenesKeepTheirPrecision)
{
    const Scene scene = withNode({{"translation", {1e7, -1e7, 3e6}}, {"scale", {0.01, 0.01, 0.01}}});
    expectNear(glm::dvec3(scene.positions[1]) - glm::dvec3(scene.positions[0]), {0.01, 0, 0}, 1e-8);
    expectNear(corner(scene, 0, 0), {1e7, -1e7, 3e6}, 1e-8);
}

TEST(GltfGeometry, DropsWhatHasNoAreaAndSaysSo)
{
    TinyGltf file;
    file.attributes()["POSITION"] =
        file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0, 7, 7, 7, 7, 7, 7, 7, 7, 7}, "VEC3");
    file.attributes().erase("NORMAL");
    EXPECT_EQ(file.load().triangles.size(), 1u);
    EXPECT_TRUE(file.warns("Dropped a triangle without area (2 times)."));
}

// glTF's reference is MikkTSpace with v up: without mirroring, the bitangent w cross(n, t) runs up the picture.
TEST(GltfGeometry, TangentsFollowTheTexture)
{
    TinyGltf file;
    file.material()["normalTexture"] = {{"index", file.texture({0, 0, 0, 0})}};
    const auto firstTangent = [&](const std::vector<float>& uv) {
        file.attributes()["TEXCOORD_0"] = file.accessor<float>(uv, "VEC2");
        const Scene scene = file.load();
        return scene.tangents[scene.triangles[0].vertices[0]];
    };
    EXPECT_EQ(firstTangent({0, 1, 1, 1, 0, 0}), glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(firstTangent({1, 1, 0, 1, 1, 0}), glm::vec4(-1, 0, 0, -1)); // mirrored
    EXPECT_EQ(firstTangent({0, 0, 0, 1, 1, 0}), glm::vec4(0, 1, 0, 1));   // turned
    EXPECT_NEAR(glm::length(glm::vec3(firstTangent({0, 0, 0, 0, 0, 0}))), 1, 1e-6);

    file.attributes()["TANGENT"] = file.accessor<float>({0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1}, "VEC4");
    EXPECT_EQ(firstTangent({0, 1, 1, 1, 0, 0}), glm::vec4(0, 1, 0, -1)); // the file's own
    file.json["nodes"][0]["scale"] = {1, 1, -1};
    EXPECT_EQ(firstTangent({0, 1, 1, 1, 0, 0}), glm::vec4(0, 1, 0, 1)); // the normal has turned over
}

} // namespace scene
