#include "passes/sequence.h"

#include "engine/base/check.h"
#include "engine/scene/motion.h"

#include <algorithm>
#include <cmath>

namespace passes
{

double playedAt(double seconds, double length, bool loop)
{
    if (!loop || length == 0) return std::clamp(seconds, 0.0, length);
    const double turned = std::fmod(seconds, length);
    return turned < 0 ? turned + length : turned;
}

double Playback::secondsAt(int64_t frame, const scene::Motion& motion) const
{
    double length = 0;
    for (const uint32_t animation : animations) length = std::max(length, motion.animations.at(animation).seconds);
    return playedAt(start + double(frame) * step, length, loop);
}

Sequence::Sequence(scene::Scene& scene, Playback playback, uint32_t camera, CameraAt cameraAt)
    : cameraAt_(std::move(cameraAt)), scene_(&scene), playback_(std::move(playback)), camera_(camera)
{
    CHECK(scene.motion && !playback_.animations.empty());
}

void Sequence::bring(Renderer& renderer, int64_t frame) const
{
    if (scene_) {
        const double seconds = playback_.secondsAt(frame, *scene_->motion);
        if (renderer.sceneSeconds() == seconds && !cameraAt_) return; // it is there
        scene::pose(*scene_, playback_.animations, seconds);
        renderer.setScene(*scene_, seconds);
    }
    if (cameraAt_)
        renderer.setCamera(cameraAt_(uint64_t(std::max<int64_t>(frame, 0))));
    else if (scene_)
        renderer.setCamera(scene_->cameras[camera_]);
}

} // namespace passes
