#include "tests/support/gpu_pictures.h"

#include <algorithm>
#include <cstddef>

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

uint32_t batchesOf(uint32_t runs)
{
    constexpr uint32_t MOST = 256; // in one picture
    return (runs + MOST - 1) / MOST;
}

PictureEstimates renderRuns(gpu::Device& device, const scene::Scene& scene, const passes::Settings& settings,
                            uint32_t runs, const passes::CameraAt& cameraAt, const SceneAt& sceneAt,
                            const Enough& enough)
{
    const uint32_t batches = batchesOf(runs), batch = (runs + batches - 1) / batches;
    PictureRuns result;
    passes::Renderer renderer(device, scene, settings, {.moves = bool(sceneAt)}, batch);
    const auto bring = [&](uint32_t frame) {
        if (cameraAt) renderer.setCamera(cameraAt(frame));
        if (sceneAt) renderer.setScene(sceneAt(frame), frame);
    };
    passes::Settings own = settings;
    for (uint32_t run = 0; run < runs; ++own.seed) {
        bring(0);
        renderer.apply(own);
        renderer.reset();
        for (uint32_t frame = 0; frame < settings.frames; ++frame) {
            bring(frame);
            renderer.renderFrame();
        }
        const image::Image all = renderer.read(passes::colorOf(renderer.settings()));
        image::Image one{.width = settings.width, .height = settings.height};
        const auto pixels = std::ptrdiff_t(size_t{one.width} * one.height);
        for (uint32_t i = 0; i < batch && run < runs; ++i, ++run) {
            one.pixels.assign(all.pixels.begin() + i * pixels, all.pixels.begin() + (i + 1) * pixels);
            result.add(one);
        }
        expectFinite(renderer);
        if (enough && enough(result.estimates())) break;
    }
    return result.estimates();
}

PictureEstimates renderFrames(gpu::Device& device, const scene::Scene& scene, passes::Settings settings,
                              uint32_t frames)
{
    settings.frames = 1;
    return renderRuns(device, scene, settings, frames);
}

} // namespace support
