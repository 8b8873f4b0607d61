// No light leaks in or out: closed meshes have no cracks for rays, whatever their triangles, their scale and the
// distance of the rays' origin; and a ray that leaves a surface does not meet it again.

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "engine/scene/shapes.h"
#include "tests/shaders/scene/intersect_fixture.h"

namespace
{

constexpr float SCALES[] = {1e-3f, 1.0f, 1e5f};

class Random
{
  public:
    float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine_); }
    uint32_t below(uint32_t count) { return std::uniform_int_distribution<uint32_t>(0, count - 1)(engine_); }
    glm::vec3 direction()
    {
        const float z = between(-1, 1), phi = between(0, 2 * std::numbers::pi_v<float>), r = std::sqrt(1 - z * z);
        return {r * std::cos(phi), r * std::sin(phi), z};
    }

  private:
    std::mt19937 engine_{1};
};

Mesh meshOf(const scene::Scene& scene)
{
    return {.positions = scene.positions, .triangles = scene.triangles};
}

Mesh sphere(float radius)
{
    scene::Scene scene;
    scene::addSphere(scene, 0, glm::vec3(0), radius, 4);
    return meshOf(scene);
}

Mesh box(float size)
{
    scene::Scene scene;
    scene::addBox(scene, 0, glm::vec3(-size), glm::vec3(size));
    return meshOf(scene);
}

// A tube whose sides are slivers as long as the tube and 1/3000 as wide, closed by fans; and among them triangles of
// no area, and every third one twice.
Mesh needles(float size)
{
    constexpr uint32_t SEGMENTS = 10000;
    Mesh mesh;
    std::vector<glm::vec3> low, high;
    for (uint32_t i = 0; i < SEGMENTS; ++i) {
        const double phi = 2 * std::numbers::pi * i / SEGMENTS;
        const glm::dvec3 rim = {0.5 * std::cos(phi), 0.5 * std::sin(phi), 0};
        low.push_back(size * glm::vec3(rim - glm::dvec3(0, 0, 1)));
        high.push_back(size * glm::vec3(rim + glm::dvec3(0, 0, 1)));
    }
    for (uint32_t i = 0; i < SEGMENTS; ++i) {
        const uint32_t j = (i + 1) % SEGMENTS;
        mesh.add(low[i], low[j], high[i]);
        mesh.add(low[j], high[j], high[i]);
        mesh.add(low[j], low[i], {0, 0, -size});
        mesh.add(high[i], high[j], {0, 0, size});
        if (i % 3 == 0) mesh.add(low[i], low[j], high[i]);
        if (i % 5 == 0) mesh.add(low[i], high[i], low[i]);
    }
    return mesh;
}

// From inside, in all directions; at the mesh's vertices and at points of its edges, where cracks would be.
std::vector<TestRay> raysWithin(const Mesh& mesh, float room, int count)
{
    Random random;
    std::vector<TestRay> rays;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 origin = room * random.between(0, 1) * random.direction();
        glm::vec3 direction = random.direction();
        if (i % 3 != 0) {
            const auto& v = mesh.triangles[random.below(uint32_t(mesh.triangles.size()))].vertices;
            const float along = i % 3 == 1 ? 0 : random.between(0, 1);
            direction = glm::normalize(glm::mix(mesh.positions[v[0]], mesh.positions[v[1]], along) - origin);
        }
        rays.push_back({origin, FAR, direction});
    }
    return rays;
}

class IntersectLeaks : public Intersect
{
  protected:
    void expectClosed(const Mesh& mesh, const std::vector<TestRay>& rays)
    {
        size_t leaks = 0, differing = 0;
        for (const Hit& hit : trace(mesh, rays)) {
            leaks += hit.isHit() ? 0 : 1;
            differing += hit.isHit() != hit.occluded() ? 1 : 0;
        }
        EXPECT_EQ(leaks, 0u) << "of " << rays.size();
        EXPECT_EQ(differing, 0u);
    }
};

TEST_F(IntersectLeaks, NoRayLeavesAClosedMesh)
{
    for (const float scale : SCALES) {
        SCOPED_TRACE(scale);
        for (const Mesh& mesh : {sphere(scale), box(scale)}) expectClosed(mesh, raysWithin(mesh, 0.9f * scale, 20000));
    }
}

TEST_F(IntersectLeaks, NoRayPassesBetweenNeedles)
{
    for (const float scale : SCALES) {
        SCOPED_TRACE(scale);
        const Mesh mesh = needles(scale);
        expectClosed(mesh, raysWithin(mesh, 0.45f * scale, 20000));
    }
}

// The mesh off the origin by 100 of its sizes: coordinates have fewer bits to spare, but all of them agree.
TEST_F(IntersectLeaks, NoRayLeavesAClosedMeshFarFromTheOrigin)
{
    Mesh mesh = sphere(1);
    std::vector<TestRay> rays = raysWithin(mesh, 0.9f, 20000);
    const glm::vec3 shift = {100, -70, 30};
    for (glm::vec3& p : mesh.positions) p += shift;
    for (TestRay& ray : rays) ray.origin += shift;
    expectClosed(mesh, rays);
}

// A camera 10^4 scene sizes away.
TEST_F(IntersectLeaks, FarCamerasSeeAClosedMeshWhole)
{
    for (const float scale : SCALES) {
        SCOPED_TRACE(scale);
        const Mesh mesh = sphere(scale);
        Random random;
        std::vector<TestRay> rays;
        for (int i = 0; i < 20000; ++i) {
            const glm::vec3 origin = 1e4f * scale * random.direction();
            const glm::vec3 target = 0.9f * scale * random.direction();
            rays.push_back({origin, FAR, glm::normalize(target - origin)});
        }
        expectClosed(mesh, rays);
        const std::vector<Hit> hits = trace(mesh, rays);
        size_t farSides = 0;
        for (size_t i = 0; i < hits.size(); ++i) {
            if (!hits[i].isHit()) continue;
            const auto& v = mesh.triangles[hits[i].triangle()].vertices;
            const glm::vec3 a = mesh.positions[v[0]], b = mesh.positions[v[1]], c = mesh.positions[v[2]];
            farSides += glm::dot(glm::cross(b - a, c - a), rays[i].direction) < 0 ? 0 : 1;
            const glm::dvec3 point = a + hits[i].u * (b - a) + hits[i].v * (c - a);
            const double along = glm::dot(point - glm::dvec3(rays[i].origin), glm::dvec3(rays[i].direction));
            ASSERT_NEAR(hits[i].t, along, 1e-6 * along); // 24 bits can say no more
        }
        EXPECT_EQ(farSides, 0u);
    }
}

struct Leaving { // as offset_test.comp has it
    glm::vec4 v0, v1, v2, direction;
};

class OffsetOrigin : public Intersect
{
  protected:
    // At an angle above the triangle's plane that is as often tiny as not, on the side of `side` times its normal.
    static Leaving leave(const Mesh& mesh, uint32_t triangle, float side, Random& random)
    {
        const auto& v = mesh.triangles[triangle].vertices;
        const glm::dvec3 a = mesh.positions[v[0]], b = mesh.positions[v[1]], c = mesh.positions[v[2]];
        const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
        const glm::dvec3 along = glm::normalize(glm::cross(normal, glm::dvec3(random.direction())));
        const double elevation = std::pow(10.0, random.between(-5, 0)); // radians
        const glm::dvec3 direction = std::cos(elevation) * along + double(side) * std::sin(elevation) * normal;
        float s = random.between(0, 1), t = random.between(0, 1);
        if (s + t > 1) s = 1 - s, t = 1 - t;
        return {glm::vec4(a, s), glm::vec4(b, t), glm::vec4(c, 0), glm::vec4(direction, 0)};
    }

    std::vector<Hit> traceLeaving(const Mesh& mesh, const std::vector<Leaving>& rays)
    {
        const scene::Bvh bvh =
            scene::buildBvh({.positions = mesh.positions, .triangles = mesh.triangles}, device().limits().tableBytes);
        const gpu::Buffer nodes = upload("nodes", bvh.nodes, gpu::Usage::Table);
        const gpu::Buffer triangles = upload("triangles", bvh.triangles, gpu::Usage::Table);
        const gpu::Buffer rayBuffer = upload("rays", rays);
        const gpu::Buffer hits = create<Hit>("hits", rays.size());
        run({.shader = TEST_SPIRV_DIR "/offset_test",
             .buffers = {{"Nodes", &nodes}, {"Triangles", &triangles}, {"Rays", &rayBuffer}, {"Hits", &hits}},
             .threads = {uint32_t(rays.size())}});
        return download<Hit>(hits);
    }
};

// From the outside of a convex body no ray meets it again.
TEST_F(OffsetOrigin, LeavesAConvexBodyForGood)
{
    for (const float scale : SCALES)
        for (const Mesh& mesh : {sphere(scale), box(scale)}) {
            SCOPED_TRACE(scale);
            Random random;
            std::vector<Leaving> rays;
            for (int i = 0; i < 20000; ++i)
                rays.push_back(leave(mesh, random.below(uint32_t(mesh.triangles.size())), 1, random));
            size_t again = 0;
            for (const Hit& hit : traceLeaving(mesh, rays)) again += hit.isHit() || hit.occluded() ? 1 : 0;
            EXPECT_EQ(again, 0u);
        }
}

// Inside a closed body every ray meets it, and in a box not the face that it left.
TEST_F(OffsetOrigin, StaysInsideAClosedBodyAndOffItsOwnFace)
{
    for (const float scale : SCALES) {
        SCOPED_TRACE(scale);
        for (const Mesh& mesh : {sphere(scale), box(scale)}) {
            Random random;
            std::vector<Leaving> rays;
            std::vector<uint32_t> from;
            for (int i = 0; i < 20000; ++i) {
                from.push_back(random.below(uint32_t(mesh.triangles.size())));
                rays.push_back(leave(mesh, from.back(), -1, random));
            }
            const std::vector<Hit> hits = traceLeaving(mesh, rays);
            size_t leaks = 0, own = 0;
            for (size_t i = 0; i < hits.size(); ++i) {
                leaks += hits[i].isHit() && hits[i].occluded() ? 0 : 1;
                own += hits[i].triangle() == from[i] ? 1 : 0;
            }
            EXPECT_EQ(leaks, 0u);
            EXPECT_EQ(own, 0u);
        }
    }
}

} // namespace
