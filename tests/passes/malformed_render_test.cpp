// Every file of ../shared/malformed that loads renders to finite, non-negative pixels.

#include <cmath>

#include "engine/base/error.h"
#include "engine/scene/environment.h"
#include "engine/scene/gltf_loader.h"
#include "passes/renderer.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/shared_files.h"

namespace
{

class MalformedRender : public GpuTest
{
};

// Shadowless first frames of a sphere of sky: enough to see what an environment holds.
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

TEST_F(MalformedRender, WhatLoadsRendersFinite)
{
    SKIP_WITHOUT_SHARED("malformed/manifest.json");
    if (device().adapter().name.find("SwiftShader") != std::string::npos)
        GTEST_SKIP() << "only on llvmpipe: SwiftShader compiles three pipelines for each of the files too slowly";
    size_t rendered = 0;
    for (const MalformedFile& file : malformedFiles()) {
        if (file.kind == "image" || !file.mayLoad) continue;
        const std::optional<scene::Scene> scene = tryLoad(file);
        if (!scene) continue;
        SCOPED_TRACE(file.path.filename().string() + ": " + file.why);
        passes::Settings settings;
        settings.width = 16;
        settings.height = 9;
        passes::Renderer renderer(device(), *scene, settings);
        for (int frame = 0; frame < 2; ++frame) renderer.renderFrame();
        const image::Image picture = renderer.readColor();
        for (const glm::vec3& pixel : picture.pixels) {
            for (int c = 0; c < 3; ++c) ASSERT_TRUE(std::isfinite(pixel[c]) && pixel[c] >= 0) << pixel[c];
        }
        for (const auto& [stage, count] : renderer.stats().nonFinite) EXPECT_EQ(count, 0u) << stage;
        ++rendered;
    }
    EXPECT_GE(rendered, 50u); // the manifest promises as many
}
