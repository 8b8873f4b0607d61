// The built-in scenes that move.
// Covers engine/scene/procedural_carousel.cpp, engine/scene/procedural_flags.cpp.

#include "engine/scene/motion.h"
#include "engine/scene/procedural.h"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace scene
{
namespace
{

const std::vector<uint32_t> FIRST = {0};
constexpr int TIMES = 23; // no key's time but 0

class MovingScene : public testing::TestWithParam<const char*>
{
  protected:
    static Scene make()
    {
        const std::vector<BuiltInScene> scenes = builtInScenes();
        return std::ranges::find(scenes, std::string(GetParam()), &BuiltInScene::name)->make();
    }

    const Scene rest_ = make();
    const Motion& motion_ = *rest_.motion;
    const double period_ = motion_.animations[0].seconds;

    Scene at(double seconds) const
    {
        Scene scene = rest_;
        pose(scene, FIRST, seconds);
        return scene;
    }
    Scene atTime(int i) const { return at(period_ * i / TIMES); }
};

double worstDistance(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b)
{
    double worst = 0;
    for (size_t i = 0; i < a.size(); ++i) worst = std::max(worst, double(glm::distance(a[i], b[i])));
    return worst;
}

TEST_P(MovingScene, HasOneAnimationThatClosesItsLoop)
{
    ASSERT_EQ(motion_.animations.size(), 1u);
    EXPECT_EQ(motion_.animations[0].name, rest_.name);
    EXPECT_EQ(motion_.animations[0].fault, "");
    const Scene first = at(0), last = at(period_);
    EXPECT_EQ(first.positions, rest_.positions);
    EXPECT_EQ(first.normals, rest_.normals);
    EXPECT_LT(worstDistance(last.positions, first.positions), 1e-5);
    EXPECT_LT(worstDistance(last.normals, first.normals), 1e-5);
    for (size_t i = 0; i < first.lights.size(); ++i) {
        EXPECT_LT(glm::distance(first.lights[i].position, last.lights[i].position), 1e-5f);
        EXPECT_LT(glm::distance(first.lights[i].direction, last.lights[i].direction), 1e-5f);
    }
    // Its speed closes, too.
    const double step = 1e-2;
    const std::vector<glm::vec3> before = at(period_ - step).positions, after = at(step).positions;
    for (size_t v = 0; v < after.size(); ++v) {
        const glm::dvec3 in = rest_.positions[v] - before[v], out = after[v] - rest_.positions[v];
        ASSERT_LT(glm::distance(in, out) / step, 0.25) << v; // m/s
    }
}

TEST_P(MovingScene, MovesItsPartsAndNothingElse)
{
    std::vector<bool> isPart(rest_.positions.size(), false);
    std::vector<double> farthest(motion_.parts.size(), 0);
    for (const Motion::Part& part : motion_.parts)
        std::fill_n(isPart.begin() + part.firstVertex, motion_.meshes[part.mesh].vertices.count, true);
    for (int i = 0; i < TIMES; ++i) {
        const Scene scene = atTime(i);
        for (size_t v = 0; v < isPart.size(); ++v) {
            if (isPart[v]) continue;
            ASSERT_EQ(scene.positions[v], rest_.positions[v]) << v;
        }
        for (size_t p = 0; p < farthest.size(); ++p) {
            const uint32_t first = motion_.parts[p].firstVertex;
            for (size_t v = first; v < first + motion_.meshes[motion_.parts[p].mesh].vertices.count; ++v)
                farthest[p] = std::max(farthest[p], double(glm::distance(scene.positions[v], rest_.positions[v])));
        }
    }
    const auto still = static_cast<size_t>(std::ranges::count(isPart, false));
    EXPECT_GT(still, 300u);
    for (const double distance : farthest) EXPECT_GT(distance, 0.1);
}

TEST_P(MovingScene, HasSoundTrianglesInsideItsHallAtAllTimes)
{
    glm::vec3 low(1e9f), high(-1e9f);
    for (const glm::vec3& p : rest_.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    for (int i = 0; i < TIMES; ++i) {
        const Scene scene = atTime(i);
        int bad = 0;
        for (const glm::vec3& p : scene.positions)
            bad += !(glm::all(glm::lessThanEqual(low, p)) && glm::all(glm::lessThanEqual(p, high)));
        for (const auto& [vertices, material] : scene.triangles) {
            const glm::dvec3 a = scene.positions[vertices[0]], b = scene.positions[vertices[1]],
                             c = scene.positions[vertices[2]];
            const glm::dvec3 area = glm::cross(b - a, c - a);
            bad += !(glm::length(area) > 1e-6);
            for (const uint32_t vertex : vertices) bad += !(glm::dot(glm::dvec3(scene.normals[vertex]), area) > 0);
        }
        EXPECT_EQ(bad, 0) << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Of, MovingScene, testing::Values("carousel", "flags"),
                         [](const auto& test) { return std::string(test.param); });

// Of all edges of the triangles of a part, the largest change of length, over all times.
double strain(const Scene& rest, const Motion::Part& part, double period)
{
    double worst = 0;
    Scene scene = rest;
    for (int i = 0; i < TIMES; ++i) {
        pose(scene, FIRST, period * i / TIMES);
        for (size_t t = 0; t < rest.motion->meshes[part.mesh].triangles.size(); ++t) {
            const auto& vertices = rest.triangles[part.firstTriangle + t].vertices;
            for (size_t e = 0; e < 3; ++e) {
                const uint32_t a = vertices[e], b = vertices[(e + 1) % 3];
                worst = std::max(worst, std::abs(double(glm::distance(scene.positions[a], scene.positions[b])) -
                                                 glm::distance(rest.positions[a], rest.positions[b])));
            }
        }
    }
    return worst;
}

TEST(Carousel, IsRigidAndTakesEmittersAndSpotlightsAlong)
{
    const Scene scene = makeCarousel();
    std::set<uint32_t> emitters;
    for (const Motion::Part& part : scene.motion->parts) {
        EXPECT_LT(strain(scene, part, 8), 2e-6) << part.name;
        const uint32_t material = scene.triangles[part.firstTriangle].material;
        if (scene.materials[material].emission != glm::vec3(0)) emitters.insert(material);
    }
    EXPECT_EQ(emitters.size(), 5u);
    ASSERT_EQ(scene.lights.size(), 2u);
    Scene later = scene;
    pose(later, FIRST, 1);
    for (const size_t i : {0u, 1u}) {
        EXPECT_EQ(later.lights[i].position, scene.lights[i].position);
        EXPECT_GT(glm::distance(later.lights[i].direction, scene.lights[i].direction), 0.1f);
    }
}

TEST(Flags, DeformByMorphTargetsAndOneBySkin)
{
    const Scene scene = makeFlags();
    int skinned = 0;
    for (const Motion::Part& part : scene.motion->parts) {
        EXPECT_GT(strain(scene, part, 4), 1e-3) << part.name;
        skinned += part.skin != NONE;
    }
    EXPECT_EQ(scene.motion->parts.size(), 5u);
    EXPECT_EQ(skinned, 1);
}

} // namespace
} // namespace scene
