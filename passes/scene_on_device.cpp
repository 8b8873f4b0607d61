#include "passes/scene_on_device.h"

#include "engine/base/clock.h"
#include "engine/base/fingerprint.h"
#include "engine/scene/motion.h"

#include <cmath>
#include <span>

namespace passes
{

SceneOnDevice::SceneOnDevice(gpu::Device& gpu, const scene::Scene& scene, const scene::Camera& first,
                             const SceneOptions& options)
    : device(gpu), pipelines(options.pipelines ? options.pipelines : std::make_shared<PipelinePool>(gpu)),
      camera(first), featureSet(options.featureSet)
{
    const auto start = Clock::now();
    const uint64_t maxTableBytes = gpu.limits().tableBytes;
    const auto take = [&](const scene::SceneTables& made) {
        lights = made.lights;
        features = made.features;
        lengthScale = made.lengthScale;
        radianceScale = made.radianceScale;
    };
    if (options.moves) {
        poses = std::make_unique<scene::MovingTables>(scene, maxTableBytes, options.bvhProgress, featureSet);
        tables = std::make_unique<scene::GpuScene>(gpu, *poses);
        poses->forgetShared();
        take(poses->last());
        motion = scene.motion->fingerprint();
        show(0, scene);
    } else {
        const scene::SceneTables made = scene::makeSceneTables(scene, maxTableBytes, options.bvhProgress, featureSet);
        tables = std::make_unique<scene::GpuScene>(gpu, made);
        bvh = scene::statsOf(made);
        take(made);
    }
    tablesSeconds = secondsSince(start) - bvh.buildSeconds;
}

SceneOnDevice::SceneOnDevice(const SceneOnDevice& other)
    : device(other.device), pipelines(other.pipelines), camera(other.camera), featureSet(other.featureSet),
      tablesSeconds(other.tablesSeconds), bvh(other.bvh), lights(other.lights), features(other.features),
      lengthScale(other.lengthScale), radianceScale(other.radianceScale), motion(other.motion),
      poses(std::make_unique<scene::MovingTables>(*other.poses)),
      tables(std::make_unique<scene::GpuScene>(device, *poses, other.tables.get()))
{
}

void SceneOnDevice::show(uint32_t world, const scene::Scene& posed)
{
    const scene::SceneTables& pose = poses->at(posed);
    tables->write(device, world, pose, poses->changes());
    bvh = scene::statsOf(pose);
    lights = pose.lights;
}

shared::CameraUniform SceneOnDevice::uniformOf(const scene::Camera& seenBy, double aspect) const
{
    const double height = seenBy.orthographic ? seenBy.ymag * lengthScale : std::tan(seenBy.yfov / 2);
    const auto vector = [](const glm::dvec3& v) { return glm::vec4(glm::vec3(v), 0.0f); };
    return {.position = vector(seenBy.position * lengthScale),
            .right = vector(seenBy.right * height * aspect),
            .up = vector(seenBy.up * height),
            .forward = vector(seenBy.forward)};
}

Variant SceneOnDevice::variant(const Settings& settings) const
{
    return makeVariant(features, settings, camera.orthographic, tables->stack(), moves());
}

bool SceneOnDevice::viewRepeats(const Settings& settings) const
{
    return featureSet == scene::FeatureSet::Needed && settings.pixelFilter == PixelFilter::Center && !features.blend;
}

uint64_t SceneOnDevice::fingerprint() const
{
    const double scales[] = {lengthScale, radianceScale};
    const shared::CameraUniform first = uniformOf(camera, 1);
    const uint64_t contents = ::fingerprint(std::as_bytes(std::span(scales)), tables->contents() ^ motion);
    return ::fingerprint(std::as_bytes(std::span(&first, 1)), contents);
}

} // namespace passes
