// Covers engine/scene/gltf_images.cpp, engine/scene/gltf_values.cpp, engine/scene/texture_image.cpp.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/tiny_gltf.h"

namespace scene
{
namespace
{

using nlohmann::json;

// The material that the file's triangle gets.
Material materialOf(const TinyGltf& file)
{
    const Scene scene = file.load();
    return scene.materials[scene.triangles[0].material];
}

Material with(const json& members)
{
    TinyGltf file;
    file.material() = members;
    return materialOf(file);
}

} // namespace

TEST(GltfMaterials, DefaultsAreThoseOfGltf)
{
    for (const Material& material : {materialOf(TinyGltf()), with(json::object())}) {
        EXPECT_EQ(material.baseColor, glm::vec4(1));
        EXPECT_EQ(material.metallic, 1);
        EXPECT_EQ(material.roughness, 1);
        EXPECT_EQ(material.emission, glm::vec3(0));
        EXPECT_EQ(material.ior, 1.5f);
        EXPECT_EQ(material.specular, 1);
        EXPECT_EQ(material.transmission, 0);
        EXPECT_EQ(material.alpha, Alpha::Opaque);
        EXPECT_FALSE(material.doubleSided || material.unlit);
        EXPECT_EQ(material.baseColorTexture.image, NONE);
    }
}

TEST(GltfMaterials, FactorsAndModes)
{
    const Material material =
        with({{"name", "m"},
              {"pbrMetallicRoughness",
               {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.25}}},
              {"emissiveFactor", {1, 0.5, 0}},
              {"alphaMode", "MASK"},
              {"alphaCutoff", 0.75},
              {"doubleSided", true}});
    EXPECT_EQ(material.name, "m");
    EXPECT_EQ(material.baseColor, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(material.metallic, 0.5f);
    EXPECT_EQ(material.roughness, 0.25f);
    EXPECT_EQ(material.emission, glm::vec3(1, 0.5f, 0));
    EXPECT_EQ(material.alpha, Alpha::Mask);
    EXPECT_EQ(material.alphaCutoff, 0.75f);
    EXPECT_TRUE(material.doubleSided);
    EXPECT_EQ(with({{"alphaMode", "BLEND"}}).alpha, Alpha::Blend);
    EXPECT_EQ(with({{"alphaMode", "MASK"}}).alphaCutoff, 0.5f);
}

TEST(GltfMaterials, Extensions)
{
    const Material material =
        with({{"emissiveFactor", {0, 0.5, 1}},
              {"extensions",
               {{"KHR_materials_emissive_strength", {{"emissiveStrength", 40}}},
                {"KHR_materials_ior", {{"ior", 1.25}}},
                {"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {1, 2, 3}}}},
                {"KHR_materials_transmission", {{"transmissionFactor", 0.75}}}}}});
    EXPECT_EQ(material.emission, glm::vec3(0, 20, 40));
    EXPECT_EQ(material.ior, 1.25f);
    EXPECT_EQ(material.specular, 0.5f);
    EXPECT_EQ(material.specularColor, glm::vec3(1, 2, 3));
    EXPECT_EQ(material.transmission, 0.75f);
    EXPECT_TRUE(material.thin);

    const auto extended = [](const char* name, const json& members) {
        return with({{"extensions", {{name, members}}}});
    };
    EXPECT_FALSE(extended("KHR_materials_volume", {{"thicknessFactor", 0.1}}).thin);
    EXPECT_TRUE(extended("KHR_materials_volume", {{"thicknessFactor", 0}}).thin);
    EXPECT_TRUE(extended("KHR_materials_unlit", json::object()).unlit);
}

TEST(GltfMaterials, EveryTextureFindsItsPlace)
{
    TinyGltf file;
    file.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
    for (int i = 0; i < 7; ++i) file.texture({uint32_t(i) << 16, 0, 0, 0}); // told apart by their first pixel's red
    file.json["textures"][0]["sampler"] = 0;
    file.material() = {
        {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 1}}}}},
        {"normalTexture", {{"index", 2}, {"scale", 0.5}, {"texCoord", 1}}},
        {"emissiveTexture", {{"index", 3}}},
        {"extensions",
         {{"KHR_materials_transmission", {{"transmissionTexture", {{"index", 4}, {"texCoord", 1}}}}},
          {"KHR_materials_specular",
           {{"specularTexture", {{"index", 5}}}, {"specularColorTexture", {{"index", 6}}}}}}}};
    const Scene scene = file.load();
    const Material& m = scene.materials[0];
    const TextureUse* uses[] = {&m.baseColorTexture,    &m.metallicRoughnessTexture, &m.normalTexture,
                                &m.emissiveTexture,     &m.transmissionTexture,      &m.specularTexture,
                                &m.specularColorTexture};
    for (size_t i = 0; i < 7; ++i) {
        ASSERT_NE(uses[i]->image, NONE) << i;
        EXPECT_EQ(scene.images[uses[i]->image].rgba[0], i);
        EXPECT_EQ(uses[i]->uvSet, i == 2 || i == 4 ? 1u : 0u);
        EXPECT_EQ(uses[i]->wrapU, i == 0 ? Wrap::Clamp : Wrap::Repeat);
        EXPECT_EQ(uses[i]->wrapV, i == 0 ? Wrap::Mirror : Wrap::Repeat);
        EXPECT_EQ(uses[i]->nearest, i == 0);
    }
    EXPECT_EQ(m.normalScale, 0.5f);
}

// KHR_texture_transform: uv' = translation * rotation * scale * uv, with the extension's matrices.
TEST(GltfMaterials, TextureTransforms)
{
    TinyGltf file;
    file.material()["pbrMetallicRoughness"]["baseColorTexture"] = {
        {"index", file.texture({1, 2, 3, 4})},
        {"extensions",
         {{"KHR_texture_transform",
           {{"offset", {0.25, 0.5}}, {"rotation", 0.3}, {"scale", {2, 3}}, {"texCoord", 1}}}}}};
    const TextureUse use = materialOf(file).baseColorTexture;
    EXPECT_EQ(use.uvSet, 1u); // the extension's wins
    const float c = std::cos(0.3f), s = std::sin(0.3f);
    EXPECT_LT(glm::distance(use.row0, glm::vec3(2 * c, 3 * s, 0.25f)), 1e-6f);
    EXPECT_LT(glm::distance(use.row1, glm::vec3(-2 * s, 3 * c, 0.5f)), 1e-6f);
}

TEST(GltfMaterials, ImagesKeepTheirRowsAndChannels)
{
    TinyGltf file;
    file.material()["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", file.texture({0xff8000, 2, 3, 0x0000ff})}};
    const Scene scene = file.load();
    ASSERT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.images[0].rgba,
              (std::vector<uint8_t>{255, 128, 0, 255, 0, 0, 2, 255, 0, 0, 3, 255, 0, 0, 255, 255}));
}

// Two pixels of RGB, 16 bits a sample; and one gray pixel of 0x8080.
constexpr const char* DEEP_PNG =
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABEAIAAAAr0DSeAAAAFUlEQVR42mNoYGBg/P9fyKShgZEBABn5A8c9k4zlAAAAAElF"
    "TkSuQmCC";
constexpr const char* DEEP_GRAY_PNG =
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABEAAAAABq7kcWAAAAC0lEQVR42mNoaAAAAYMBAYuRVfIAAAAASUVORK5CYII=";

TEST(GltfMaterials, SamplesOf16BitsAreKeptWhereEightDoNotHoldThem)
{
    const auto imageOf = [](const char* png) {
        TinyGltf file;
        file.json["images"] = {{{"uri", std::string("data:image/png;base64,") + png}}};
        file.json["textures"] = {{{"source", 0}}};
        file.material() = {{"normalTexture", {{"index", 0}}}};
        return file.load().images.at(0);
    };
    const Image deep = imageOf(DEEP_PNG), gray = imageOf(DEEP_GRAY_PNG);
    EXPECT_EQ(deep.deep, (std::vector<uint16_t>{0x8000, 0x0001, 0xffff, 0xffff, 0x1234, 0x8080, 0x0100, 0xffff}));
    EXPECT_TRUE(deep.rgba.empty());
    EXPECT_EQ(deep.sample(0), 0x8000 / 65535.0);
    EXPECT_EQ(gray.rgba, (std::vector<uint8_t>{0x80, 0x80, 0x80, 0xff}));
    EXPECT_TRUE(gray.deep.empty());
}

TEST(GltfMaterials, ValuesOutOfRangeAreClampedAndNamed)
{
    TinyGltf file;
    file.material() = {{"pbrMetallicRoughness", {{"roughnessFactor", 5}, {"metallicFactor", -1}}}};
    EXPECT_EQ(materialOf(file).roughness, 1);
    EXPECT_EQ(materialOf(file).metallic, 0);
    EXPECT_TRUE(file.warns("Clamped the roughness of a material from 5 to 1."));
    EXPECT_TRUE(file.warns("Clamped the metallic factor of a material from -1 to 0."));
    file.material() = {{"normalTexture", {{"index", file.texture({0, 0, 0, 0})}, {"texCoord", 3}}}};
    EXPECT_TRUE(file.warns("Ignored a texture that uses TEXCOORD_3: only sets 0 and 1 are supported."));
}

TEST(GltfMaterials, OnlyUsedMaterialsAndImagesAreKept)
{
    TinyGltf file;
    file.texture({1, 1, 1, 1});
    file.texture({2, 2, 2, 2});
    file.material() = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}};
    file.json["materials"].push_back({{"name", "used"}, {"emissiveTexture", {{"index", 1}}}});
    file.primitive()["material"] = 1;
    const Scene scene = file.load();
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.materials[0].name, "used");
    ASSERT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.images[0].rgba[2], 2);
}

} // namespace scene
