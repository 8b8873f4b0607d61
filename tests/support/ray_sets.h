#pragma once
// Rays as a path tracer makes them, traced by Embree: the oracle of traversal tests and the opponent of
// traversal_bench.

#include <cstdint>
#include <memory>
#include <vector>

#include <embree3/rtcore.h>
#include <glm/glm.hpp>

#include "engine/scene/scene.h"

struct TestRay {
    glm::vec3 origin;
    float tMax = 0;
    glm::vec3 direction; // unit
    uint32_t unused = 0;
};
static_assert(sizeof(TestRay) == 32); // two vec4 in a kernel's buffer

// A triangle mesh in Embree.
class EmbreeScene
{
  public:
    // `flags`: RTC_SCENE_FLAG_ROBUST for a watertight oracle.
    EmbreeScene(const std::vector<glm::vec3>& positions, const std::vector<scene::Triangle>& triangles,
                RTCSceneFlags flags = RTC_SCENE_FLAG_NONE);
    RTCScene handle() const { return scene_.get(); }
    RTCRayHit intersect(const TestRay& ray) const; // hit.primID is the triangle

  private:
    std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device_;
    std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> scene_;
};

RTCRayHit embreeRay(const TestRay& ray);

struct RaySets {
    std::vector<TestRay> camera;  // neighbours in the picture are neighbours here (Morton order)
    std::vector<TestRay> shadow;  // from their hits to random points of the scene's box, up to there
    std::vector<TestRay> bounce;  // from their hits, cosine-distributed
    std::vector<TestRay> bounce2; // from the hits of those
    std::vector<TestRay> shadow2; // from the hits of `bounce` to random points of the scene's box
};

// size x size camera rays, size a power of two; the other sets have as many rays less those whose path has left the
// scene.
RaySets makeRaySets(const scene::Scene& scene, const EmbreeScene& embree, uint32_t size);
