#pragma once
// A scene as its renderers share it: the tables on a device, what they need compiled in, and how they are scaled.

#include <functional>
#include <memory>

#include "engine/gpu/gpu.h"
#include "engine/scene/gpu_scene.h"
#include "engine/scene/scene.h"
#include "passes/pipeline_pool.h"
#include "passes/settings.h"
#include "passes/variant.h"
#include "shaders/shared/frame.h"

namespace passes
{

struct SceneOptions {
    // Everything: all features are compiled in, and even what cannot have changed is replayed. It gives the same
    // picture, slower: for tests and benchmarks.
    scene::FeatureSet featureSet = scene::FeatureSet::Needed;
    std::function<void(double)> bvhProgress = {};      // of building the tree, from 0 to 1
    std::shared_ptr<PipelinePool> pipelines = nullptr; // of this device, whose shaders need not be compiled again
    bool moves = false; // the scene's own motion (scene::Motion): its pose will be changed
};

struct SceneOnDevice {
    // `camera`: the first one that it is seen by; all others have its kind of projection, which is compiled in.
    SceneOnDevice(gpu::Device& device, const scene::Scene& scene, const scene::Camera& camera,
                  const SceneOptions& options = {});
    // Another one of a scene that moves, in the same poses until show(); textures and pipelines are shared.
    SceneOnDevice(const SceneOnDevice& other);
    SceneOnDevice& operator=(const SceneOnDevice&) = delete;

    bool moves() const { return poses != nullptr; }

    // The pose of a scene that moves, as world 0 or 1, from the next submission on.
    void show(uint32_t world, const scene::Scene& posed);

    shared::CameraUniform uniformOf(const scene::Camera& camera, double aspect) const;
    Variant variant(const Settings& settings) const;
    // Does every pixel see the same point in each frame while the camera rests? This alone lets frames take over what
    // an earlier one saw: not where rays go anywhere through the pixel, nor where surfaces exist by chance.
    bool viewRepeats(const Settings& settings) const;
    uint64_t fingerprint() const; // of geometry, materials, lights, first camera, and what moves

    gpu::Device& device;
    std::shared_ptr<PipelinePool> pipelines;
    scene::Camera camera;
    scene::FeatureSet featureSet;
    double tablesSeconds = 0; // scene -> tables, without the BVH
    scene::BvhStats bvh;
    scene::LightCounts lights;
    scene::SceneFeatures features;
    double lengthScale = 1, radianceScale = 1;  // scaled over the scene's units
    uint64_t motion = 0;                        // a fingerprint
    std::unique_ptr<scene::MovingTables> poses; // of a scene that moves
    std::unique_ptr<scene::GpuScene> tables;
};

} // namespace passes
