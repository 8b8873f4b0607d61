#include "tests/support/gpu_pictures.h"

#include <gtest/gtest.h>

namespace support
{

namespace
{

void expectFinite(passes::Renderer& renderer)
{
    for (const auto& [stage, count] : renderer.stats().nonFinite) EXPECT_EQ(count, 0u) << "not finite in " << stage;
}

} // namespace

PictureEstimates renderFrames(gpu::Device& device, const scene::Scene& scene, const passes::Settings& settings,
                              uint32_t frames, scene::FeatureSet features)
{
    passes::Renderer renderer(device, scene, settings, {}, features);
    PictureRuns runs;
    for (uint32_t i = 0; i < frames; ++i) {
        renderer.renderFrame();
        runs.add(renderer.readFrame());
    }
    expectFinite(renderer);
    return runs.estimates();
}

PictureEstimates renderRuns(gpu::Device& device, const scene::Scene& scene, const passes::Settings& settings,
                            uint32_t runs, const passes::CameraAt& cameraAt)
{
    PictureRuns result;
    passes::Renderer renderer(device, scene, settings);
    passes::Settings own = settings;
    for (uint32_t run = 0; run < runs; ++run, ++own.seed) {
        if (cameraAt) renderer.setCamera(cameraAt(0));
        renderer.apply(own);
        renderer.reset();
        for (uint32_t frame = 0; frame < settings.frames; ++frame) {
            if (cameraAt) renderer.setCamera(cameraAt(frame));
            renderer.renderFrame();
        }
        result.add(renderer.readColor());
        expectFinite(renderer);
    }
    return result.estimates();
}

} // namespace support
