// Covers engine/scene/bvh_embree.cpp.

#include "engine/scene/bvh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "tests/engine/scene/bvh_reading.h"
#include "tests/support/random_points.h"

namespace
{

// Triangles of all sizes, from long slivers that spatial splits like to specks.
Mesh soup(uint32_t count, uint32_t seed)
{
    Random random(seed);
    Mesh mesh;
    for (uint32_t i = 0; i < count; ++i) {
        const glm::vec3 center = random.point(1.0f);
        const float size = std::pow(10.0f, random.between(-4.0f, 0.0f));
        mesh.add(center + random.point(size), center + random.point(size), center + random.point(0.3f * size));
    }
    return mesh;
}

// Pairs of triangles with a common edge, each beginning at a vertex of its own, as long and as thin as those above.
Mesh pairedSoup(uint32_t count, uint32_t seed)
{
    Random random(seed);
    Mesh mesh;
    const auto addTurned = [&](std::array<glm::vec3, 3> v) {
        std::rotate(v.begin(), v.begin() + int(random.between(0, 2.999f)), v.end());
        mesh.add(v[0], v[1], v[2]);
    };
    for (uint32_t i = 0; i < count / 2; ++i) {
        const glm::vec3 center = random.point(1.0f);
        const float size = std::pow(10.0f, random.between(-4.0f, 0.0f));
        const glm::vec3 a = center + random.point(size), b = center + random.point(size);
        const glm::vec3 c = center + random.point(0.3f * size), d = a + b - c;
        addTurned({a, b, c});
        addTurned({b, a, d});
    }
    return mesh;
}

TEST(Bvh, ReachesEveryTriangleAndEveryNodeOnce)
{
    for (const uint32_t count : {1u, 2u, 3u, 4u, 9u, 100u, 20000u}) {
        const Bvh bvh = soup(count, count).build();
        const std::multiset<uint32_t> found = reachable(bvh);
        EXPECT_EQ(found.size(), bvh.stats.triangleRecords);
        EXPECT_EQ(std::set<uint32_t>(found.begin(), found.end()).size(), count);
        EXPECT_EQ(*found.rbegin(), count - 1);

        uint64_t nodes = 1;
        walk(
            bvh, [&](const Box&) { return true; }, [](uint32_t) {});
        std::vector<uint32_t> pending = {0};
        std::set<uint32_t> seen = {0};
        while (!pending.empty()) {
            const std::vector<Slot> slots = slotsOf(bvh, pending.back());
            pending.pop_back();
            for (const Slot& slot : slots)
                if (slot.node) {
                    EXPECT_TRUE(seen.insert(*slot.node).second);
                    pending.push_back(*slot.node);
                    ++nodes;
                }
        }
        EXPECT_EQ(nodes, bvh.stats.nodes);
        EXPECT_GE(bvh.nodes.size(), nodes * shared::BVH_NODE_STRIDE);
        EXPECT_LE(double(bvh.nodes.size()), (1.05 * double(nodes) + 8) * shared::BVH_NODE_STRIDE) << "too many gaps";
    }
}

// Spatial splits cut triangles: each of a triangle's points must lie in some leaf that names it, ancestors' boxes
// included.
void expectCovered(const Mesh& mesh, size_t leastRecords)
{
    const Bvh bvh = mesh.build();
    ASSERT_GT(bvh.stats.triangleRecords, leastRecords) << "no spatial split: the test says too little";
    Random random(8);
    for (uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
        const auto v = mesh.corners(triangle);
        for (int sample = 0; sample < 8; ++sample) {
            double a = random.between(0, 1), b = random.between(0, 1);
            if (a + b > 1) a = 1 - a, b = 1 - b;
            if (sample == 0) a = b = 0;
            if (sample == 1) b = 1 - a;
            const glm::dvec3 point = (1 - a - b) * v[0] + a * v[1] + b * v[2];
            bool found = false;
            walk(
                bvh, [&](const Box& box) { return contains(box, point); },
                [&](uint32_t candidate) { found |= candidate == triangle; });
            ASSERT_TRUE(found) << "triangle " << triangle;
        }
    }
}

TEST(Bvh, BoxesCoverEveryPointOfEveryTriangle)
{
    expectCovered(soup(5000, 7), 5000);
    expectCovered(pairedSoup(5000, 7), 2500);
}

// Exactly those in a pair that share an edge, in opposite directions, and what the record says of their corners.
TEST(Bvh, PairsTrianglesAcrossTheirCommonEdge)
{
    const Mesh mesh = pairedSoup(2000, 9);
    const Bvh bvh = mesh.build();
    uint64_t paired = 0;
    for (size_t record = 0; record < bvh.stats.triangleRecords; ++record) {
        const glm::uvec4* words = recordOf(bvh, record);
        const auto cornerAt = [&](int i) {
            return glm::dvec3(std::bit_cast<float>(words[i].x), std::bit_cast<float>(words[i].y),
                              std::bit_cast<float>(words[i].z));
        };
        const std::vector<uint32_t> triangles = trianglesOf(bvh, record);
        for (size_t k = 0; k < triangles.size(); ++k) {
            const std::array<int, 3> corners = k == 0 ? std::array{0, 1, 2} : std::array{3, 2, 1};
            const uint32_t turn = words[k == 0 ? 2 : 3].w;
            ASSERT_LT(turn, 3u);
            for (uint32_t i = 0; i < 3; ++i)
                EXPECT_EQ(cornerAt(corners[i]), mesh.corners(triangles[k])[(turn + i) % 3]) << "record " << record;
        }
        if (triangles.size() == 1) continue;
        EXPECT_EQ(triangles[0] / 2, triangles[1] / 2);
        ++paired;
    }
    EXPECT_GE(paired, 900u); // a few have a smaller box apart than together
}

// A pair's box must be smaller than both boxes; a triangle that is asked for its alpha stays alone, one that is left
// out pairs with none.
TEST(Bvh, PairsOnlyWhereThatPays)
{
    const auto recordsOf = [](const Mesh& mesh, std::vector<uint8_t> alpha = {}) {
        return scene::buildBvh({.positions = mesh.positions, .triangles = mesh.triangles, .needsAlphaTest = alpha},
                               ANY_SIZE)
            .stats.triangleRecords;
    };
    Mesh square;
    square.add({0, 0, 0}, {1, 0, 0}, {1, 1, 0});
    square.add({0, 0, 0}, {1, 1, 0}, {0, 1, 0});
    EXPECT_EQ(recordsOf(square), 1u);
    EXPECT_EQ(recordsOf(square, {1, 0}), 2u);
    EXPECT_EQ(recordsOf(square, {1, 1}), 2u);

    Mesh folded; // flat boxes at right angles: together a cube
    folded.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    folded.add({1, 0, 0}, {0, 0, 0}, {0, 0, 1});
    EXPECT_EQ(recordsOf(folded), 2u);

    Mesh sameWay; // the common edge in the same direction twice: one of them faces the other way
    sameWay.add({0, 0, 0}, {1, 0, 0}, {1, 1, 0});
    sameWay.add({1, 1, 0}, {0, 0, 0}, {0, 1, 0});
    sameWay.triangles[1].vertices = {sameWay.triangles[1].vertices[1], sameWay.triangles[1].vertices[0],
                                     sameWay.triangles[1].vertices[2]};
    EXPECT_EQ(recordsOf(sameWay), 1u);
    std::swap(sameWay.triangles[1].vertices[0], sameWay.triangles[1].vertices[1]);
    EXPECT_EQ(recordsOf(sameWay), 2u);

    Mesh broken;
    broken.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    broken.add({1, 0, 0}, {0, 0, 0}, {2, 0, 0}); // on the edge's line
    EXPECT_EQ(recordsOf(broken), 1u);
    EXPECT_EQ(reachable(broken.build()), (std::multiset<uint32_t>{0}));
}

TEST(Bvh, FindsTheNearestHitThatBruteForceFinds)
{
    Mesh mesh = soup(1000, 3);
    const Mesh paired = pairedSoup(1000, 3);
    for (uint32_t t = 0; t < paired.triangles.size(); ++t) {
        const auto& v = paired.triangles[t].vertices;
        mesh.add(paired.positions[v[0]], paired.positions[v[1]], paired.positions[v[2]]);
    }
    const Bvh bvh = mesh.build();
    Random random(4);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
        const RayD ray = {random.point(2.0f), glm::normalize(glm::dvec3(random.point(1.0f)))};
        double expected = std::numeric_limits<double>::infinity();
        for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
            expected = std::min(expected, hitDistance(mesh.corners(t), ray));
        double found = std::numeric_limits<double>::infinity();
        walk(
            bvh, [&](const Box& box) { return meets(box, ray); },
            [&](uint32_t t) { found = std::min(found, hitDistance(mesh.corners(t), ray)); });
        ASSERT_EQ(found, expected);
        hits += std::isfinite(found) ? 1 : 0;
    }
    EXPECT_GT(hits, 500);
}

TEST(Bvh, LeavesOutDegenerateAndNonFiniteTriangles)
{
    constexpr float INFINITE = std::numeric_limits<float>::infinity();
    constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();
    Mesh mesh;
    mesh.add({0, 0, 0}, {0, 0, 0}, {1, 0, 0}); // two corners equal
    mesh.add({0, 0, 0}, {1, 1, 1}, {2, 2, 2}); // on a line
    mesh.add({0, 0, 0}, {1, 0, 0}, {0, NOT_A_NUMBER, 0});
    mesh.add({0, 0, 0}, {1, 0, 0}, {0, INFINITE, 0});
    mesh.add({0, 0, 0}, {1, 0, 0}, {0, 3e38f, 0});       // its area is not finite
    mesh.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});           // good
    mesh.add({0, 0, 0}, {1e-12f, 0, 0}, {0, 1e-12f, 0}); // small, good
    const Bvh bvh = mesh.build();
    EXPECT_EQ(reachable(bvh), (std::multiset<uint32_t>{5, 6}));
    EXPECT_EQ(bvh.stats.skippedTriangles, 5u);
}

TEST(Bvh, OfNothingHasOneNodeWithoutChildren)
{
    const Bvh bvh = Mesh{}.build();
    EXPECT_EQ(bvh.nodes.size(), shared::BVH_NODE_STRIDE);
    EXPECT_EQ(bvh.triangles.size(), shared::BVH_RECORD_STRIDE); // a table cannot be empty
    EXPECT_TRUE(reachable(bvh).empty());
    EXPECT_EQ(bvh.stats.sahCost, 0);
}

TEST(Bvh, MarksTrianglesThatNeedAnAlphaTest)
{
    const Mesh mesh = soup(100, 5);
    std::vector<uint8_t> flags(100);
    for (size_t i = 0; i < flags.size(); i += 3) flags[i] = 1;
    const Bvh bvh =
        scene::buildBvh({.positions = mesh.positions, .triangles = mesh.triangles, .needsAlphaTest = flags}, ANY_SIZE);
    for (size_t record = 0; record < bvh.stats.triangleRecords; ++record) {
        const uint32_t tag = bvh.triangles[record * shared::BVH_RECORD_STRIDE].w;
        EXPECT_EQ((tag & shared::BVH_ALPHA_FLAG) != 0, flags[tag & ~shared::BVH_ALPHA_FLAG] != 0);
    }
}

// What a search over all triangles around a vertex would take hours for.
TEST(Bvh, OfManyTrianglesAroundAVertexIsBuiltSoon)
{
    constexpr uint32_t COUNT = 300000;
    Mesh fan;
    fan.positions = {{0, 0, 0}};
    for (uint32_t i = 0; i <= COUNT; ++i) {
        const double angle = 6.28 * i / COUNT;
        fan.positions.push_back({float(std::cos(angle)), float(std::sin(angle)), 0});
        if (i > 0) fan.triangles.push_back({.vertices = {0, i, i + 1}});
    }
    EXPECT_LT(fan.build().stats.triangleRecords, COUNT);
    Mesh same;
    for (uint32_t i = 0; i < COUNT; ++i) same.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    EXPECT_GE(same.build().stats.triangleRecords, COUNT);
}

TEST(Bvh, OfTrianglesThatCannotBeToldApartStaysShallow)
{
    Mesh mesh;
    for (int i = 0; i < 2000; ++i) mesh.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const Bvh bvh = mesh.build();
    EXPECT_EQ(reachable(bvh).size(), 2000u);
    EXPECT_LE(bvh.stats.depth, 8u);
}

// Each triangle half as large and half as far: the best binary tree is a chain.
TEST(Bvh, OfAGeometricSeriesFitsTheStack)
{
    Mesh mesh;
    for (int i = 0; i < 120; ++i) {
        const float s = std::ldexp(1.0f, 40 - i);
        mesh.add({s, 0, 0}, {s, s, 0}, {s, 0, s});
    }
    const Bvh bvh = mesh.build();
    EXPECT_EQ(reachable(bvh).size() - (bvh.stats.triangleRecords - 120), 120u);
    EXPECT_LE(bvh.stats.depth, shared::BVH_STACK_SIZE);
}

TEST(Bvh, ThatDoesNotFitIsAnErrorAndSplitsGiveWayFirst)
{
    const Mesh mesh = soup(5000, 7);
    const uint64_t recordBytes = shared::BVH_RECORD_STRIDE * sizeof(glm::uvec4);
    const Bvh split = mesh.build();
    ASSERT_GT(split.stats.triangleRecords, mesh.triangles.size());
    const Bvh tight = mesh.build(mesh.triangles.size() * recordBytes);
    EXPECT_EQ(tight.stats.triangleRecords, mesh.triangles.size());
    EXPECT_THROW(mesh.build(mesh.triangles.size() * recordBytes - 1), Error);
}

TEST(Bvh, ReportsProgressThatGrowsToOne)
{
    const Mesh mesh = soup(20000, 2);
    std::vector<double> reports;
    scene::buildBvh({.positions = mesh.positions,
                     .triangles = mesh.triangles,
                     .progress = [&](double fraction) { reports.push_back(fraction); }},
                    ANY_SIZE);
    ASSERT_GE(reports.size(), 2u);
    EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
    EXPECT_EQ(reports.back(), 1.0);
}

} // namespace
