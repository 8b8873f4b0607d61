// Files beside the repository render to finite, non-negative pixels: the malformed ones that load, Khronos' models, and
// real scenes.

#include <cmath>
#include <memory>
#include <optional>
#include <set>

#include "engine/base/error.h"
#include "engine/scene/environment.h"
#include "engine/scene/gltf_loader.h"
#include "engine/scene/scene_tables.h"
#include "passes/renderer.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/shared_files.h"

namespace
{

class SceneFiles : public RendererFixture
{
  protected:
    void expectFinite(const scene::Scene& scene)
    {
        passes::Settings settings;
        settings.width = 16;
        settings.height = 9;
        if (!pipelines_) pipelines_ = std::make_shared<passes::PipelinePool>(device());
        passes::Renderer renderer(device(), scene, settings, {.pipelines = pipelines_});
        for (int frame = 0; frame < 2; ++frame) renderer.renderFrame();
        const image::Image picture = renderer.read(passes::colorOf(renderer.settings()));
        for (const glm::vec3& pixel : picture.pixels) {
            for (int c = 0; c < 3; ++c) ASSERT_TRUE(std::isfinite(pixel[c]) && pixel[c] >= 0) << pixel[c];
        }
        for (const auto& [stage, count] : renderer.stats().nonFinite) EXPECT_EQ(count, 0u) << stage;
    }

    std::shared_ptr<passes::PipelinePool> pipelines_; // of all scenes: many need the same shaders
};

// What the device would see of a scene: many malformed files differ in nothing that reaches it.
std::string fingerprint(const scene::Scene& scene)
{
    const scene::SceneTables tables = scene::makeSceneTables(scene, uint64_t{1} << 27, {});
    std::string bytes;
    for (const auto* table : {&tables.bvh.nodes, &tables.bvh.triangles, &tables.attributes, &tables.texels,
                              &tables.environment, &tables.sceneData})
        bytes.append(reinterpret_cast<const char*>(table->data()), table->size() * sizeof(glm::uvec4));
    const scene::Camera& camera = scene.cameras[0];
    for (const glm::dvec3& v : {camera.position, camera.forward, glm::dvec3(camera.yfov, camera.xmag, camera.ymag)})
        bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
    return bytes;
}

scene::Scene underSky(const std::filesystem::path& file)
{
    scene::Scene scene;
    scene.cameras.emplace_back();
    scene::setEnvironment(scene, file, 1);
    return scene;
}

std::optional<scene::Scene> tryLoad(const MalformedFile& file)
{
    try {
        return file.kind == "hdr" ? underSky(file.path) : scene::loadGltf(file.path);
    } catch (const Error&) {
        return std::nullopt; // whether it may is the business of tests/engine/scene/malformed_test.cpp
    }
}

} // namespace

TEST_F(SceneFiles, MalformedOnesThatLoad)
{
    SKIP_WITHOUT_SHARED("malformed/manifest.json");
    std::set<std::string> rendered;
    for (const MalformedFile& file : malformedFiles()) {
        if (file.kind == "image" || !file.mayLoad) continue;
        const std::optional<scene::Scene> scene = tryLoad(file);
        if (!scene || !rendered.insert(fingerprint(*scene)).second) continue;
        SCOPED_TRACE(file.path.filename().string() + ": " + file.why);
        expectFinite(*scene);
    }
    std::printf("%zu different scenes\n", rendered.size());
    EXPECT_GE(rendered.size(), 50u);
}

TEST_F(SceneFiles, ConformanceModels)
{
    SKIP_WITHOUT_SHARED("scenes/conformance");
    for (const std::string name :
         {"AlphaBlendModeTest", "AttenuationTest", "BoxVertexColors", "Cameras", "CesiumMan", "EmissiveStrengthTest",
          "GlassBrokenWindow", "LightsPunctualLamp", "MultiUVTest", "NormalTangentMirrorTest", "SpecularTest",
          "TextureTransformTest", "TransmissionRoughnessTest", "TwoSidedPlane", "UnlitTest"}) {
        SCOPED_TRACE(name);
        expectFinite(scene::loadGltf(sharedPath("scenes/conformance/" + name + "/" + name + "_lit.gltf")));
    }
}

TEST_F(SceneFiles, Sponza)
{
    SKIP_WITHOUT_SHARED("scenes/sponza/sponza_curtain_spots.gltf");
    const scene::Scene scene = scene::loadGltf(sharedPath("scenes/sponza/sponza_curtain_spots.gltf"));
    EXPECT_EQ(scene.lights.size(), 10u);
    EXPECT_EQ(scene.cameras.size(), 3u);
    EXPECT_NEAR(double(scene.triangles.size()), 261844, 10);
    expectFinite(scene);
}
