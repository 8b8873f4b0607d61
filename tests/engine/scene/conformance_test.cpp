// Khronos' sample models beside the repository: what each is there to exercise arrives in the scene.

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/scene/gltf_loader.h"
#include "tests/support/shared_files.h"

namespace scene
{
namespace
{

class Conformance : public testing::Test
{
  protected:
    void SetUp() override { SKIP_WITHOUT_SHARED("scenes/conformance"); }

    static Scene load(const std::string& name) { return loadGltf(sharedPath("scenes/conformance/" + name)); }

    // Part of a warning.
    static bool warns(const Scene& scene, const std::string& part)
    {
        return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                           [&](const std::string& warning) { return warning.find(part) != std::string::npos; });
    }
    template <class Predicate>
    static size_t countMaterials(const Scene& scene, const Predicate& predicate)
    {
        return size_t(std::count_if(scene.materials.begin(), scene.materials.end(), predicate));
    }
};

// How many triangles lie with their shading normals, as far as one can tell.
double shareFacingTheirNormals(const Scene& scene)
{
    size_t facing = 0;
    for (const Triangle& triangle : scene.triangles) {
        const auto& [a, b, c] = triangle.vertices;
        const glm::vec3 normal =
            glm::cross(scene.positions[b] - scene.positions[a], scene.positions[c] - scene.positions[a]);
        facing += glm::dot(normal, scene.normals[a] + scene.normals[b] + scene.normals[c]) > 0;
    }
    return double(facing) / double(scene.triangles.size());
}

} // namespace

TEST_F(Conformance, AllLoadButDraco)
{
    size_t loaded = 0;
    for (const std::filesystem::path& file : sharedModels("scenes/conformance")) {
        SCOPED_TRACE(file.string());
        if (file.string().find("Draco") != std::string::npos) {
            try {
                loadGltf(file);
                ADD_FAILURE() << "loaded";
            } catch (const Error& error) {
                EXPECT_NE(std::string(error.what()).find("requires the extension \"KHR_draco_mesh_compression\""),
                          std::string::npos)
                    << error.what();
            }
            continue;
        }
        const Scene scene = loadGltf(file);
        EXPECT_FALSE(scene.triangles.empty());
        EXPECT_GE(shareFacingTheirNormals(scene), 0.97);
        ++loaded;
    }
    EXPECT_GE(loaded, 100u);
}

TEST_F(Conformance, ContainersAgree)
{
    for (const std::string name : {"Box", "BoxTextured"}) {
        const Scene plain = load(name + "/" + name + ".gltf");
        for (const std::string& other : {name + "/Binary/" + name + ".glb", name + "/Embedded/" + name + ".gltf"}) {
            const Scene scene = load(other);
            EXPECT_EQ(scene.positions, plain.positions);
            EXPECT_EQ(scene.triangles.size(), plain.triangles.size());
            ASSERT_EQ(scene.images.size(), plain.images.size());
            for (size_t i = 0; i < plain.images.size(); ++i) EXPECT_EQ(scene.images[i].rgba, plain.images[i].rgba);
        }
    }
    EXPECT_EQ(load("BoxInterleaved/BoxInterleaved.gltf").triangles.size(), 12u);
    const Scene duck = load("Duck/Binary/Duck.glb"), quantized = load("Duck/Quantized/Duck.gltf");
    ASSERT_EQ(duck.triangles.size(), quantized.triangles.size());
    EXPECT_LT(glm::distance(duck.origin, quantized.origin), 0.01);
}

TEST_F(Conformance, CamerasScenesInstancesAndPrimitives)
{
    const Scene cameras = load("Cameras/Cameras.gltf");
    ASSERT_EQ(cameras.cameras.size(), 2u);
    EXPECT_NE(cameras.cameras[0].orthographic, cameras.cameras[1].orthographic);
    EXPECT_EQ(load("SimpleMeshes/SimpleMeshes.gltf").triangles.size(), 2u);
    EXPECT_EQ(load("SimpleInstancing/SimpleInstancing.gltf").triangles.size(), 125u * 12);
    EXPECT_EQ(load("SimpleSparseAccessor/SimpleSparseAccessor.gltf").triangles.size(), 12u);
    EXPECT_EQ(load("TriangleWithoutIndices/TriangleWithoutIndices.gltf").triangles.size(), 1u);
    const Scene modes = load("MeshPrimitiveModes/MeshPrimitiveModes.gltf");
    EXPECT_FALSE(modes.triangles.empty());
    EXPECT_TRUE(warns(modes, "points or lines"));
}

TEST_F(Conformance, MaterialsAndLights)
{
    const Scene alpha = load("AlphaBlendModeTest/AlphaBlendModeTest.gltf");
    for (const Alpha mode : {Alpha::Opaque, Alpha::Mask, Alpha::Blend})
        EXPECT_GT(countMaterials(alpha, [&](const Material& m) { return m.alpha == mode; }), 0u);
    EXPECT_EQ(countMaterials(load("UnlitTest/UnlitTest.gltf"), [](const Material& m) { return m.unlit; }), 2u);
    EXPECT_GT(countMaterials(load("TransmissionTest/TransmissionTest.gltf"),
                             [](const Material& m) { return m.transmission > 0; }),
              0u);
    EXPECT_GT(countMaterials(load("EmissiveStrengthTest/EmissiveStrengthTest.gltf"),
                             [](const Material& m) { return glm::length(m.emission) > 4; }),
              0u);
    EXPECT_GT(countMaterials(load("TwoSidedPlane/TwoSidedPlane.gltf"), [](const Material& m) { return m.doubleSided; }),
              0u);
    EXPECT_GT(countMaterials(load("SpecularTest/SpecularTest.gltf"),
                             [](const Material& m) { return m.specularColor != glm::vec3(1); }),
              0u);
    const Scene attenuation = load("AttenuationTest/AttenuationTest.gltf");
    EXPECT_GT(countMaterials(attenuation, [](const Material& m) { return !m.thin; }), 0u);
    EXPECT_TRUE(warns(attenuation, "attenuation"));
    EXPECT_TRUE(warns(load("ClearCoatTest/ClearCoatTest.gltf"), "\"KHR_materials_clearcoat\""));
    EXPECT_FALSE(load("LightsPunctualLamp/LightsPunctualLamp.gltf").lights.empty());
}

TEST_F(Conformance, TexturesAndVertexColors)
{
    EXPECT_FALSE(load("BoxVertexColors/BoxVertexColors.gltf").colors.empty());
    const Scene multi = load("MultiUVTest/MultiUVTest.gltf");
    EXPECT_FALSE(multi.uv1.empty());
    EXPECT_GT(countMaterials(multi, [](const Material& m) { return m.emissiveTexture.uvSet == 1; }), 0u);
    std::set<Wrap> wraps;
    for (const Material& material : load("TextureSettingsTest/TextureSettingsTest.gltf").materials)
        wraps.insert(material.baseColorTexture.wrapU);
    EXPECT_EQ(wraps.size(), 3u);
    EXPECT_GT(countMaterials(load("TextureTransformTest/TextureTransformTest.gltf"),
                             [](const Material& m) { return m.baseColorTexture.row0.y != 0; }),
              0u);
    EXPECT_FALSE(load("NormalTangentTest/NormalTangentTest.gltf").tangents.empty());
}

} // namespace scene
