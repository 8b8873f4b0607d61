// Covers engine/scene/tinygltf_implementation.cpp, engine/scene/warnings.cpp.

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/scene/gltf_uri.h"
#include "engine/scene/motion.h"
#include "tests/support/tiny_gltf.h"

namespace scene
{

TEST(GltfDocument, RequiredExtensionsMustBeKnown)
{
    TinyGltf file;
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_materials_ior", "KHR_draco_mesh_compression"};
    EXPECT_EQ(file.error(), "The file requires the extension \"KHR_draco_mesh_compression\", which is not supported.");
    file.json["extensionsRequired"] = {"KHR_materials_ior"};
    EXPECT_EQ(file.error(), "");
}

TEST(GltfDocument, IgnoredExtensionsAreNamed)
{
    TinyGltf file;
    file.json["extensionsUsed"] = {"KHR_materials_ior", "KHR_materials_clearcoat", "EXT_unheard_of"};
    file.material()["extensions"] = {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}};
    EXPECT_TRUE(file.warns("Ignored the extension \"KHR_materials_clearcoat\" on 1 material."));
    EXPECT_TRUE(file.warns("Ignored the extension \"EXT_unheard_of\"."));
    for (const std::string& warning : file.load().warnings)
        EXPECT_EQ(warning.find("KHR_materials_ior"), std::string::npos) << warning;
}

TEST(GltfDocument, AnimationsLeaveTheScenesPoseAsTheNodesStateIt)
{
    TinyGltf file;
    const Scene still = file.load();
    EXPECT_EQ(still.motion, nullptr);
    file.animate({{"node", 0}, {"path", "translation"}}, {0, 1}, {0, 0, 0, 9, 9, 9}, "VEC3");
    const Scene scene = file.load();
    EXPECT_EQ(scene.origin, still.origin);
    EXPECT_EQ(scene.positions, still.positions);
    EXPECT_EQ(scene.warnings, still.warnings);
    ASSERT_NE(scene.motion, nullptr);
    EXPECT_EQ(scene.motion->animations.size(), 1u);
    EXPECT_EQ(file.load({.animations = false}).motion, nullptr);
}

TEST(GltfDocument, ErrorsNameTheObjectAndTheValue)
{
    TinyGltf file;
    file.json["nodes"][0]["mesh"] = 3;
    EXPECT_EQ(file.error(), "nodes[0].mesh is 3, but the file has 1 meshes.");
    TinyGltf other;
    other.primitive()["indices"] = other.accessor<uint16_t>({0, 1, 3}, "SCALAR");
    EXPECT_EQ(other.error(), "meshes[0].primitives[0] has the index 3 at 2, but 3 vertices.");
}

class GltfUri : public testing::Test
{
  protected:
    void SetUp() override
    {
        std::filesystem::create_directories(root / "inside" / "a b");
        std::ofstream(root / "inside" / "a b" / "ä%.bin") << "content";
        std::ofstream(root / "secret") << "secret";
        std::filesystem::create_symlink(root / "secret", root / "inside" / "link");
    }
    void TearDown() override { std::filesystem::remove_all(root); }
    std::string read(const std::string& uri, const std::filesystem::path& assetRoot = {}) const
    {
        const auto bytes = gltf::readUri(uri, {root / "inside", assetRoot});
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }

    const std::filesystem::path root =
        std::filesystem::temp_directory_path() / ("trichrome_uri_test_" + std::to_string(::getpid()));
};

TEST_F(GltfUri, ReadsPercentEncodedNamesAndData)
{
    EXPECT_EQ(read("a%20b/%C3%A4%25.bin"), "content");
    EXPECT_EQ(read("a b/\xC3\xA4%25.bin"), "content");
    EXPECT_EQ(read("data:application/octet-stream;base64,aGVsbG8="), "hello");
}

TEST_F(GltfUri, StaysInsideTheFolder)
{
    for (const std::string uri : {"../secret", "a b/../../secret", "%2e%2e/secret", "link", "/etc/passwd",
                                  "file:///etc/passwd", "http://localhost/", "%00", "", "missing", "a b", "%zz"})
        EXPECT_THROW(read(uri), Error) << uri;
}

TEST_F(GltfUri, ARootLetsFilesLieAnywhereBelowIt)
{
    const std::filesystem::path outside = root.parent_path() / (root.filename().string() + "_outside");
    std::ofstream(outside) << "outside";
    std::filesystem::create_directories(root / "textures");
    std::ofstream(root / "textures" / "x") << "x";
    std::filesystem::create_symlink(outside, root / "textures" / "out");
    EXPECT_EQ(read("../textures/x", root), "x");
    EXPECT_EQ(read("../textures/x", root / "textures"), "x");             // a root beside the scene's folder
    EXPECT_EQ(read("a%20b/%C3%A4%25.bin", root / "textures"), "content"); // and below the folder as ever
    EXPECT_EQ(read("link", root), "secret");                              // a link that stays below the root
    for (const std::string& uri :
         {"../../" + outside.filename().string(), std::string("../textures/out"), (root / "secret").string()})
        EXPECT_THROW(read(uri, root), Error) << uri;
    EXPECT_THROW(read("../secret", root / "textures"), Error);
    EXPECT_THROW(read("a%20b/%C3%A4%25.bin", root / "missing"), Error);
    try {
        read("../textures/x");
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("--asset-root"), std::string::npos) << error.what();
    }
    std::filesystem::remove(outside);
}

TEST(GltfBase64, EveryLengthAndEveryFault)
{
    const auto text = [](std::string_view encoded) {
        const auto bytes = gltf::decodeBase64(encoded);
        return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    };
    EXPECT_EQ(text(""), "");
    EXPECT_EQ(text("Zg=="), "f");
    EXPECT_EQ(text("Zm8="), "fo");
    EXPECT_EQ(text("Zm9v"), "foo");
    EXPECT_EQ(text("Zm8"), "fo"); // unpadded
    for (const char* wrong : {"Z", "Zm9vYg=", "Zm9v!g==", "Z===", "Zm 9"}) EXPECT_THROW(text(wrong), Error) << wrong;
}

} // namespace scene
