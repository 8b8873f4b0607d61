// Rays through two levels: meshes that are stored once, against Embree over copies of them.

#include <bit>
#include <cmath>
#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/scene/scene_tables.h"
#include "engine/scene/shapes.h"
#include "shaders/shared/bvh.h"
#include "tests/shaders/scene/intersect_fixture.h"
#include "tests/support/stored_meshes.h"

namespace
{

class Instances : public Intersect
{
  protected:
    // A floor, and two kinds of bodies in `count` places, turned, stretched, mirrored, one into another.
    static scene::Scene heap(uint32_t count, glm::dvec3 middle = {0, 0, 0})
    {
        scene::Scene scene;
        scene::addQuad(scene, scene::addMaterial(scene, {}), glm::vec3(middle) + glm::vec3(-4, -2, 4), {8, 0, 0},
                       {0, 0, -8});
        const uint32_t ball = scene::addMaterial(scene, {}), box = scene::addMaterial(scene, {});
        scene::addSphere(scene, ball, {0, 0, 0}, 0.8f, 2);
        scene::addBox(scene, box, {-0.5f, -0.4f, -0.7f}, {0.5f, 0.4f, 0.7f});
        std::mt19937 random(7);
        std::uniform_real_distribution<double> place(-2.5, 2.5), size(0.3, 1.0);
        std::vector<glm::dmat4> places[2];
        for (uint32_t i = 0; i < count; ++i) {
            const glm::dvec3 to(place(random), place(random), place(random)), axis(place(random), 1, place(random));
            const double side = i % 3 == 0 ? -1 : 1;
            const glm::dmat4 turned =
                glm::rotate(glm::translate(glm::dmat4(1), middle + to), place(random), glm::normalize(axis));
            places[i % 2].push_back(glm::scale(turned, {side * size(random), size(random), size(random)}));
        }
        return support::storedOnce(support::storedOnce(scene, ball, places[0]), box, places[1]);
    }
    static std::vector<TestRay> raysAt(glm::vec3 middle, size_t count)
    {
        std::mt19937 random(3);
        std::uniform_real_distribution<float> at(-3, 3);
        const auto point = [&] { return middle + glm::vec3(at(random), at(random), at(random)); };
        std::vector<TestRay> rays;
        for (size_t i = 0; i < count; ++i) {
            const glm::vec3 from = point() + (i % 2 ? glm::vec3(0, 0, 12) : glm::vec3(0)), to = point();
            rays.push_back({from, i % 5 == 0 ? glm::distance(from, to) : FAR, glm::normalize(to - from)});
        }
        return rays;
    }
    // As GpuScene lays tables out.
    std::vector<Hit> traceInstances(const scene::Scene& scene, std::vector<TestRay> rays)
    {
        const scene::SceneTables t = scene::makeSceneTables(scene, device().limits().tableBytes);
        const auto scale = float(t.lengthScale);
        for (TestRay& ray : rays) {
            ray.origin *= scale;
            if (ray.tMax != FAR) ray.tMax *= scale;
        }
        const auto nodesOf = [](const auto& rows) { return uint32_t(rows.size() / shared::BVH_NODE_STRIDE); };
        const auto recordsOf = [](const auto& rows) { return uint32_t(rows.size() / shared::BVH_RECORD_STRIDE); };
        scene::Bvh all = t.bvh;
        const uint32_t root = nodesOf(all.nodes), meshRoot = root + nodesOf(t.places.nodes);
        const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
        add(all.nodes, scene::movedNodes(t.places.nodes, root, recordsOf(all.triangles)));
        add(all.nodes,
            scene::movedNodes(t.meshes.nodes, meshRoot, recordsOf(all.triangles) + recordsOf(t.places.records)));
        std::vector<glm::uvec4> records = t.places.records;
        for (size_t i = 3; i < records.size(); i += shared::BVH_RECORD_STRIDE) records[i].x += meshRoot;
        add(all.triangles, records);
        add(all.triangles, t.meshes.triangles);
        all.stats.depth = std::max(all.stats.depth, t.meshes.stats.depth);
        constants = {{"HAS_INSTANCES", 1u}, {"INSTANCE_TREE", root}};
        std::vector<Hit> hits = trace(Mesh{}, all, rays);
        for (Hit& hit : hits) hit.t /= scale;
        return hits;
    }
    // As the device counts it -> in support::expanded().
    static uint32_t expandedIndex(const scene::Scene& scene, uint32_t triangle)
    {
        if (triangle < scene.triangles.size()) return triangle;
        size_t most = 1;
        for (const scene::Geometry& mesh : scene.meshes) most = std::max(most, mesh.triangles.size());
        const auto bits = uint32_t(std::bit_width(most - 1));
        auto index = uint32_t(scene.triangles.size());
        const uint32_t placed = triangle - index, instance = placed >> bits;
        for (uint32_t i = 0; i < instance; ++i)
            if (scene.instances[i].visible) index += uint32_t(scene.meshes[scene.instances[i].mesh].triangles.size());
        return index + (placed & ((1u << bits) - 1));
    }
    void expectAsExpanded(const scene::Scene& scene, const std::vector<TestRay>& rays, float tolerance)
    {
        const scene::Scene flat = support::expanded(scene);
        const EmbreeScene embree(flat.positions, flat.triangles, RTC_SCENE_FLAG_ROBUST);
        const std::vector<Hit> hits = traceInstances(scene, rays);
        size_t met = 0, wrong = 0, placed = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const RTCRayHit expected = embree.intersect(rays[i]);
            const bool isHit = expected.hit.geomID != RTC_INVALID_GEOMETRY_ID;
            met += isHit;
            const uint32_t triangle = hits[i].isHit() ? expandedIndex(scene, hits[i].triangle()) : 0;
            placed += hits[i].isHit() && triangle >= scene.triangles.size();
            const bool same =
                hits[i].isHit() == isHit && hits[i].occluded() == isHit &&
                (!isHit || (triangle == expected.hit.primID && std::abs(hits[i].t - expected.ray.tfar) <= tolerance));
            wrong += !same;
        }
        EXPECT_GT(met, rays.size() / 4);
        EXPECT_GT(placed, rays.size() / 8);
        EXPECT_LE(wrong, rays.size() / 2000) << "rays that pass an edge on the other side";
    }
};

} // namespace

TEST_F(Instances, AreMetAsCopiesOfTheirMeshesAre)
{
    expectAsExpanded(heap(40), raysAt({0, 0, 0}, 20000), 2e-5f);
}

// Few and many; a tree over one place, and a deep one.
TEST_F(Instances, MayBeAsManyAsTheyLike)
{
    for (const uint32_t count : {1u, 2u, 3u, 9u, 600u}) {
        scene::Scene scene = heap(count);
        const std::vector<TestRay> rays = raysAt({0, 0, 0}, 4000);
        const scene::Scene flat = support::expanded(scene);
        const EmbreeScene embree(flat.positions, flat.triangles, RTC_SCENE_FLAG_ROBUST);
        const std::vector<Hit> hits = traceInstances(scene, rays);
        size_t wrong = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const RTCRayHit expected = embree.intersect(rays[i]);
            const bool isHit = expected.hit.geomID != RTC_INVALID_GEOMETRY_ID;
            wrong += hits[i].isHit() != isHit || (isHit && std::abs(hits[i].t - expected.ray.tfar) > 2e-5f);
        }
        EXPECT_LE(wrong, 4u) << count;
    }
}

TEST_F(Instances, ThatAreHiddenAreNotMet)
{
    scene::Scene scene = heap(20);
    for (size_t i = 0; i < scene.instances.size(); i += 2) scene.instances[i].visible = false;
    expectAsExpanded(scene, raysAt({0, 0, 0}, 8000), 2e-5f);
    for (scene::Instance& instance : scene.instances) instance.visible = false;
    const std::vector<TestRay> rays = raysAt({0, 0, 0}, 1000);
    for (const Hit& hit : traceInstances(scene, rays)) {
        if (!hit.isHit()) continue;
        ASSERT_LT(hit.triangle(), scene.triangles.size());
    }
}

// Two in the same place: the first has it.
TEST_F(Instances, OfSeveralAtOneDistanceTheFirstIsMet)
{
    scene::Scene scene = heap(2);
    scene.instances[1] = scene.instances[0];
    const std::vector<Hit> hits = traceInstances(scene, raysAt({0, 0, 0}, 40000));
    size_t placed = 0;
    for (const Hit& hit : hits) {
        if (!hit.isHit() || hit.triangle() < scene.triangles.size()) continue;
        ++placed;
        const uint32_t index = expandedIndex(scene, hit.triangle());
        ASSERT_LT(index, scene.triangles.size() + scene.meshes[0].triangles.size());
    }
    EXPECT_GT(placed, 100u);
}
