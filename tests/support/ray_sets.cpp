#include "tests/support/ray_sets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <random>

#include "engine/base/check.h"

EmbreeScene::EmbreeScene(const std::vector<glm::vec3>& positions, const std::vector<scene::Triangle>& triangles,
                         RTCSceneFlags flags)
    : device_(rtcNewDevice(nullptr), rtcReleaseDevice), scene_(rtcNewScene(device_.get()), rtcReleaseScene)
{
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
    rtcSetSceneFlags(scene_.get(), flags);
    RTCGeometry mesh = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                     sizeof(glm::vec3), positions.size()));
    std::copy(positions.begin(), positions.end(), vertices);
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(uint32_t), triangles.size()));
    for (const scene::Triangle& triangle : triangles)
        indices = std::copy(triangle.vertices.begin(), triangle.vertices.end(), indices);
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene_.get(), mesh);
    rtcReleaseGeometry(mesh);
    rtcCommitScene(scene_.get());
    CHECK_EQ(int(rtcGetDeviceError(device_.get())), int(RTC_ERROR_NONE));
}

RTCRayHit embreeRay(const TestRay& ray)
{
    RTCRayHit query = {};
    query.ray.org_x = ray.origin.x;
    query.ray.org_y = ray.origin.y;
    query.ray.org_z = ray.origin.z;
    query.ray.dir_x = ray.direction.x;
    query.ray.dir_y = ray.direction.y;
    query.ray.dir_z = ray.direction.z;
    query.ray.tfar = ray.tMax;
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.primID = RTC_INVALID_GEOMETRY_ID;
    return query;
}

RTCRayHit EmbreeScene::intersect(const TestRay& ray) const
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query = embreeRay(ray);
    rtcIntersect1(scene_.get(), &context, &query);
    return query;
}

namespace
{

uint32_t everySecondBit(uint32_t bits)
{
    uint32_t result = 0;
    for (uint32_t i = 0; i < 16; ++i) result |= (bits >> (2 * i) & 1u) << i;
    return result;
}

struct Vertex {
    glm::vec3 position;
    glm::vec3 normal; // unit, on the side that the ray came from
};

std::optional<Vertex> hitOf(const scene::Scene& scene, const EmbreeScene& embree, const TestRay& ray)
{
    const RTCRayHit hit = embree.intersect(ray);
    if (hit.hit.primID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    const auto& v = scene.triangles[hit.hit.primID].vertices;
    const glm::vec3 a = scene.positions[v[0]], b = scene.positions[v[1]], c = scene.positions[v[2]];
    glm::vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    if (glm::dot(normal, ray.direction) > 0) normal = -normal;
    return Vertex{a + hit.hit.u * (b - a) + hit.hit.v * (c - a), normal};
}

} // namespace

RaySets makeRaySets(const scene::Scene& scene, const EmbreeScene& embree, uint32_t size)
{
    CHECK((size & (size - 1)) == 0);
    glm::vec3 lower(std::numeric_limits<float>::infinity());
    glm::vec3 upper = -lower;
    for (const glm::vec3& p : scene.positions) {
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
    const float offset = 1e-5f * glm::length(upper - lower);
    constexpr float FAR = std::numeric_limits<float>::max();
    std::mt19937 engine(1);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);

    const auto bounceFrom = [&](const Vertex& vertex) {
        const float z = 2 * uniform(engine) - 1, phi = 2 * std::numbers::pi_v<float> * uniform(engine);
        const float r = std::sqrt(std::max(0.0f, 1 - z * z));
        const glm::vec3 direction = vertex.normal + glm::vec3(r * std::cos(phi), r * std::sin(phi), z);
        return TestRay{vertex.position + offset * vertex.normal, FAR, glm::normalize(direction)};
    };
    const auto shadowFrom = [&](const Vertex& vertex) {
        const glm::vec3 target = lower + (upper - lower) * glm::vec3(uniform(engine), uniform(engine), uniform(engine));
        const glm::vec3 origin = vertex.position + offset * vertex.normal;
        return TestRay{origin, glm::length(target - origin), glm::normalize(target - origin)};
    };

    RaySets sets;
    const scene::Camera& camera = scene.cameras.at(0);
    const double half = std::tan(0.5 * camera.yfov);
    for (uint32_t i = 0; i < size * size; ++i) {
        const double x = (2 * (everySecondBit(i) + 0.5) / size - 1) * half;
        const double y = (1 - 2 * (everySecondBit(i >> 1) + 0.5) / size) * half;
        const glm::dvec3 direction = glm::normalize(camera.forward + x * camera.right + y * camera.up);
        sets.camera.push_back({glm::vec3(camera.position), FAR, glm::vec3(direction)});
        const std::optional<Vertex> first = hitOf(scene, embree, sets.camera.back());
        if (!first) continue;
        sets.shadow.push_back(shadowFrom(*first));
        sets.bounce.push_back(bounceFrom(*first));
        const std::optional<Vertex> second = hitOf(scene, embree, sets.bounce.back());
        if (!second) continue;
        sets.shadow2.push_back(shadowFrom(*second));
        sets.bounce2.push_back(bounceFrom(*second));
    }
    return sets;
}
