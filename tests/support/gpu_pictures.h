#pragma once
// What the renderer makes of a scene, with error bars.

#include "engine/gpu/gpu.h"
#include "engine/scene/scene.h"
#include "passes/camera_path.h"
#include "passes/renderer.h"
#include "tests/support/tile_tests.h"

namespace support
{

// `frames` frames of one renderer, each taken for an independent run: of the path tracer they are.
// A value that is not finite fails the test.
PictureEstimates renderFrames(gpu::Device& device, const scene::Scene& scene, const passes::Settings& settings,
                              uint32_t frames, scene::FeatureSet features = scene::FeatureSet::Needed);

// `runs` runs with seeds of their own, each read after settings.frames frames (their mean, or with !settings.average
// the last): for methods whose frames depend on each other. The camera moves when `cameraAt` is given.
PictureEstimates renderRuns(gpu::Device& device, const scene::Scene& scene, const passes::Settings& settings,
                            uint32_t runs, const passes::CameraAt& cameraAt = {});

} // namespace support
