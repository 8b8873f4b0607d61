#pragma once
// What the renderer makes of a scene, with error bars.

#include <functional>

#include "engine/gpu/gpu.h"
#include "engine/scene/scene.h"
#include "passes/camera_path.h"
#include "passes/renderer.h"
#include "tests/support/tile_tests.h"

namespace support
{

// The pose of a scene in a frame.
using SceneAt = std::function<scene::Scene(uint32_t frame)>;

// Runs are rendered below each other in one picture, since small dispatches cost more than they do: in so many
// pictures.
uint32_t batchesOf(uint32_t runs);

// Is what is known after some batches enough? Asked after each.
using Enough = std::function<bool(const PictureEstimates&)>;

// Independent runs, each read after settings.frames frames (their mean, or with !settings.average the last), until all
// are rendered or a batch of them was enough. The camera moves when `cameraAt` is given, the scene when `sceneAt` is. A
// value that is not finite fails the test.
PictureEstimates renderRuns(gpu::Device& device, const scene::Scene& scene, const passes::Settings& settings,
                            uint32_t runs, const passes::CameraAt& cameraAt = {}, const SceneAt& sceneAt = {},
                            const Enough& enough = {});

// Of the path tracer, whose single frames are runs.
PictureEstimates renderFrames(gpu::Device& device, const scene::Scene& scene, passes::Settings settings,
                              uint32_t frames);

} // namespace support
