#include "engine/scene/bvh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/scene/bvh_tree.h"
#include "shaders/shared/bvh.h"
#include "tests/support/random_points.h"

namespace
{

using scene::Box;
using scene::Bvh;

constexpr uint64_t ANY_SIZE = uint64_t{1} << 40;

struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<scene::Triangle> triangles;

    void add(glm::vec3 a, glm::vec3 b, glm::vec3 c)
    {
        const uint32_t first = uint32_t(positions.size());
        positions.insert(positions.end(), {a, b, c});
        triangles.push_back({.vertices = {first, first + 1, first + 2}});
    }
    std::array<glm::dvec3, 3> corners(uint32_t triangle) const
    {
        const auto& v = triangles[triangle].vertices;
        return {positions[v[0]], positions[v[1]], positions[v[2]]};
    }
    Bvh build(uint64_t maxTableBytes = ANY_SIZE) const
    {
        return scene::buildBvh({.positions = positions, .triangles = triangles}, maxTableBytes);
    }
};

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

// Reads the tables as shared/bvh.h describes them.
struct Slot {
    Box box;
    std::optional<uint32_t> node;
    std::vector<uint32_t> triangles;
};

const glm::uvec4* recordOf(const Bvh& bvh, size_t record)
{
    return &bvh.triangles[record * shared::BVH_RECORD_STRIDE];
}

std::vector<uint32_t> trianglesOf(const Bvh& bvh, size_t record)
{
    const glm::uvec4* words = recordOf(bvh, record);
    std::vector<uint32_t> triangles = {words[0].w & ~shared::BVH_ALPHA_FLAG};
    if (glm::uvec3(words[3]) != glm::uvec3(words[1])) triangles.push_back(words[1].w);
    return triangles;
}

std::vector<Slot> slotsOf(const Bvh& bvh, uint32_t node)
{
    const glm::uvec4* words = &bvh.nodes[size_t{node} * shared::BVH_NODE_STRIDE];
    const auto byteOf = [&](uint32_t plane, uint32_t slot) {
        const uint32_t word = 2 * plane + slot / 4;
        return words[2 + word / 4][int(word % 4)] >> (8 * (slot % 4)) & 255u;
    };
    std::vector<Slot> slots;
    uint32_t nextRecord = words[1].z;
    for (uint32_t s = 0; s < 8; ++s) {
        Slot slot;
        for (int axis = 0; axis < 3; ++axis) {
            const float corner = std::bit_cast<float>(words[0][axis]);
            const double step = std::ldexp(1.0, int(words[0].w >> (8 * axis) & 255u) - 127);
            slot.box.lower[axis] = float(corner + step * byteOf(uint32_t(axis), s));
            slot.box.upper[axis] = float(corner + step * byteOf(uint32_t(axis) + 3, s));
        }
        if ((words[1].x >> (24 + s) & 1u) != 0) slot.node = (words[1].y >> 8) + s;
        for (uint32_t k = 0; k < 3; ++k)
            if ((words[1].x >> (3 * s + k) & 1u) != 0)
                for (const uint32_t triangle : trianglesOf(bvh, nextRecord++)) slot.triangles.push_back(triangle);
        if (slot.node || !slot.triangles.empty()) slots.push_back(slot);
    }
    return slots;
}

template <class Enter, class Visit>
void walk(const Bvh& bvh, const Enter& enter, const Visit& visit, uint32_t node = 0)
{
    for (const Slot& slot : slotsOf(bvh, node)) {
        if (!enter(slot.box)) continue;
        for (const uint32_t triangle : slot.triangles) visit(triangle);
        if (slot.node) walk(bvh, enter, visit, *slot.node);
    }
}

bool contains(const Box& box, glm::dvec3 p)
{
    return glm::all(glm::lessThanEqual(glm::dvec3(box.lower), p)) &&
           glm::all(glm::greaterThanEqual(glm::dvec3(box.upper), p));
}

std::multiset<uint32_t> reachable(const Bvh& bvh)
{
    std::multiset<uint32_t> found;
    walk(
        bvh, [](const Box&) { return true; }, [&](uint32_t triangle) { found.insert(triangle); });
    return found;
}

struct RayD {
    glm::dvec3 origin, direction;
};

double hitDistance(const std::array<glm::dvec3, 3>& v, const RayD& ray)
{
    const glm::dvec3 e1 = v[1] - v[0], e2 = v[2] - v[0], s = ray.origin - v[0];
    const glm::dvec3 p = glm::cross(ray.direction, e2), q = glm::cross(s, e1);
    const double det = glm::dot(e1, p);
    const double a = glm::dot(s, p) / det, b = glm::dot(ray.direction, q) / det, t = glm::dot(e2, q) / det;
    const bool hit = a >= 0 && b >= 0 && a + b <= 1 && t >= 0;
    return hit ? t : std::numeric_limits<double>::infinity();
}

bool meets(const Box& box, const RayD& ray)
{
    double enter = 0, leave = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (double(box.lower[axis]) - ray.origin[axis]) / ray.direction[axis];
        const double b = (double(box.upper[axis]) - ray.origin[axis]) / ray.direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave;
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

// ------------------------------------------------------------------------------------------------------- that moves

scene::BvhInput inputOf(const Mesh& mesh)
{
    return {.positions = mesh.positions, .triangles = mesh.triangles};
}

bool isPoint(const scene::Triangle& triangle)
{
    return triangle.vertices[0] == triangle.vertices[1] && triangle.vertices[1] == triangle.vertices[2];
}

// Two tubes of triangles that share their vertices; triangles before HALF are the first one's.
constexpr uint32_t AROUND = 24, ALONG = 20, HALF = 2 * AROUND * ALONG, HALF_VERTICES = AROUND * (ALONG + 1);
Mesh tubes()
{
    Mesh mesh;
    for (uint32_t tube = 0; tube < 2; ++tube) {
        for (uint32_t i = 0; i <= ALONG; ++i)
            for (uint32_t j = 0; j < AROUND; ++j) {
                const float angle = 6.2831853f * float(j) / AROUND, r = 0.3f + 0.1f * std::sin(0.7f * float(i));
                mesh.positions.emplace_back(float(tube) + r * std::cos(angle), 0.1f * float(i) - 1,
                                            r * std::sin(angle));
            }
        for (uint32_t i = 0; i < ALONG; ++i)
            for (uint32_t j = 0; j < AROUND; ++j) {
                const uint32_t first = tube * HALF_VERTICES + i * AROUND, k = (j + 1) % AROUND;
                mesh.triangles.push_back({.vertices = {first + j, first + AROUND + j, first + k}});
                mesh.triangles.push_back({.vertices = {first + k, first + AROUND + j, first + AROUND + k}});
            }
    }
    return mesh;
}

// As scene::pose() writes them.
Mesh movedBy(Mesh mesh, glm::vec3 way)
{
    for (uint32_t v = 0; v < HALF_VERTICES; ++v) mesh.positions[v] += way;
    return mesh;
}
Mesh mirrored(Mesh mesh)
{
    for (uint32_t v = 0; v < HALF_VERTICES; ++v) mesh.positions[v].x = 0.2f - mesh.positions[v].x;
    for (uint32_t t = 0; t < HALF; ++t) std::swap(mesh.triangles[t].vertices[1], mesh.triangles[t].vertices[2]);
    return mesh;
}
Mesh shrunkToAPoint(Mesh mesh)
{
    for (uint32_t v = 0; v < HALF_VERTICES; ++v) mesh.positions[v] = {0.5f, 0.5f, 0.5f};
    for (uint32_t t = 0; t < HALF; ++t) mesh.triangles[t].vertices.fill(mesh.triangles[t].vertices[0]);
    return mesh;
}
Mesh hidden(Mesh mesh)
{
    for (uint32_t v = 0; v < HALF_VERTICES; ++v) mesh.positions[v] = {0, 0, 0};
    for (uint32_t t = 0; t < HALF; ++t) mesh.triangles[t].vertices.fill(0);
    return mesh;
}
Mesh withHoles(Mesh mesh) // of pairs one triangle is left
{
    for (uint32_t t = 0; t < HALF; t += 3) mesh.triangles[t].vertices.fill(mesh.triangles[t].vertices[0]);
    return mesh;
}
Mesh torn(Mesh mesh) // single triangles mirrored, as skins with mirroring joints may have them
{
    for (uint32_t t = 0; t < HALF; t += 5) std::swap(mesh.triangles[t].vertices[1], mesh.triangles[t].vertices[2]);
    return mesh;
}
Mesh crumpled(Mesh mesh, float size)
{
    Random random(5);
    for (uint32_t v = 0; v < HALF_VERTICES; ++v) mesh.positions[v] += random.point(size);
    return mesh;
}

// The tree holds every triangle with an area once, within the boxes of all that it is below, and its record has the
// triangle's corners where they are.
void expectHolds(const Bvh& bvh, const Mesh& mesh, const scene::MovingBvh::Most& most)
{
    EXPECT_LE(bvh.nodes.size(), most.nodeRows);
    EXPECT_LE(bvh.triangles.size(), most.recordRows);
    EXPECT_LE(bvh.stats.depth, most.depth);
    std::vector<uint32_t> seen(mesh.triangles.size(), 0);
    std::vector<Box> above;
    const auto descend = [&](auto& self, uint32_t node) -> void {
        for (const Slot& slot : slotsOf(bvh, node)) {
            above.push_back(slot.box);
            for (const uint32_t triangle : slot.triangles) {
                ++seen.at(triangle);
                for (const glm::dvec3& corner : mesh.corners(triangle))
                    for (const Box& box : above) ASSERT_TRUE(contains(box, corner)) << "triangle " << triangle;
            }
            if (slot.node) self(self, *slot.node);
            above.pop_back();
        }
    };
    if (!mesh.triangles.empty()) descend(descend, 0);
    for (uint32_t t = 0; t < seen.size(); ++t) {
        const uint32_t least = isPoint(mesh.triangles[t]) ? 0 : 1;
        ASSERT_TRUE(seen[t] == 1 || seen[t] == least) << t;
    }
    for (size_t record = 0; record < bvh.stats.triangleRecords; ++record) {
        const glm::uvec4* words = recordOf(bvh, record);
        const std::vector<uint32_t> triangles = trianglesOf(bvh, record);
        for (size_t k = 0; k < triangles.size(); ++k) {
            const std::array<int, 3> corners = k == 0 ? std::array{0, 1, 2} : std::array{3, 2, 1};
            for (uint32_t i = 0; i < 3; ++i) {
                const glm::uvec4& word = words[corners[i]];
                const glm::dvec3 corner(std::bit_cast<float>(word.x), std::bit_cast<float>(word.y),
                                        std::bit_cast<float>(word.z));
                EXPECT_EQ(corner, mesh.corners(triangles[k])[(words[k == 0 ? 2 : 3].w + i) % 3]) << "record " << record;
            }
        }
    }
    Random random(6);
    int hits = 0;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 origin(random.point(2.0f));
        const RayD ray = {origin, glm::normalize(glm::dvec3(random.point(0.7f)) - origin)};
        double expected = std::numeric_limits<double>::infinity(), found = expected;
        for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
            expected = std::min(expected, hitDistance(mesh.corners(t), ray));
        walk(
            bvh, [&](const Box& box) { return meets(box, ray); },
            [&](uint32_t t) { found = std::min(found, hitDistance(mesh.corners(t), ray)); });
        ASSERT_EQ(found, expected);
        hits += std::isfinite(found);
    }
    EXPECT_GE(hits, mesh.triangles.size() > 100 ? 30 : 0);
}

// Which tree it is, wherever its boxes are.
std::vector<uint32_t> shapeOf(const Bvh& bvh)
{
    std::vector<uint32_t> links;
    for (size_t i = 1; i < bvh.nodes.size(); i += shared::BVH_NODE_STRIDE)
        links.insert(links.end(), {bvh.nodes[i].x, bvh.nodes[i].y, bvh.nodes[i].z});
    return links;
}

TEST(MovingBvh, HoldsTheTrianglesInEveryPose)
{
    const Mesh rest = tubes();
    const std::vector<std::pair<const char*, Mesh>> poses = {{"rest", rest},
                                                             {"moved", movedBy(rest, {0.1f, 0.7f, -0.4f})},
                                                             {"far", movedBy(rest, {40, 0, 0})},
                                                             {"mirrored", mirrored(rest)},
                                                             {"a point", shrunkToAPoint(rest)},
                                                             {"hidden", hidden(rest)},
                                                             {"with holes", withHoles(rest)},
                                                             {"mirrored, with holes", withHoles(mirrored(rest))},
                                                             {"torn", torn(rest)},
                                                             {"crumpled", crumpled(rest, 0.3f)}};
    for (const auto& [first, restPose] : poses) {
        SCOPED_TRACE(std::string("rest: ") + first);
        scene::MovingBvh bvh(inputOf(restPose), ANY_SIZE);
        for (size_t i = 0; i < 2 * poses.size(); ++i) { // each after others, and once more
            const auto& [name, pose] = poses[i * 7 % poses.size()];
            SCOPED_TRACE(name);
            expectHolds(bvh.at(inputOf(pose)), pose, bvh.most());
        }
        scene::MovingBvh copy = bvh;
        bvh.at(inputOf(crumpled(rest, 1)));
        expectHolds(copy.at(inputOf(restPose)), restPose, copy.most());
    }
}

TEST(MovingBvh, KeepsPairsWhateverTransformsDo)
{
    const Mesh rest = tubes();
    scene::MovingBvh bvh(inputOf(rest), ANY_SIZE);
    const Bvh first = bvh.at(inputOf(rest));
    EXPECT_LT(first.stats.triangleRecords, 0.6 * double(rest.triangles.size()));
    for (const Mesh& pose : {mirrored(rest), shrunkToAPoint(rest), hidden(rest), withHoles(rest), rest}) {
        const Bvh moved = bvh.at(inputOf(pose));
        EXPECT_EQ(moved.stats.triangleRecords, first.stats.triangleRecords);
        EXPECT_EQ(shapeOf(moved), shapeOf(first)); // refitted: it is no worse
    }
    const Bvh pairedAnew = bvh.at(inputOf(torn(rest)));
    EXPECT_GT(pairedAnew.stats.triangleRecords, first.stats.triangleRecords);
}

// As it crumples more and more: as dear as a fresh tree after it was built anew, and never half dearer than then.
TEST(MovingBvh, IsBuiltAnewOnceItIsWornAndNotBefore)
{
    const Mesh rest = tubes();
    scene::MovingBvh bvh(inputOf(rest), ANY_SIZE);
    Bvh before = bvh.at(inputOf(rest));
    double built = before.stats.sahCost;
    int refits = 0, builds = 0;
    for (float size = 0.01f; size < 1; size *= 1.15f) {
        const Mesh pose = crumpled(rest, size);
        const Bvh now = bvh.at(inputOf(pose));
        EXPECT_GT(now.stats.buildSeconds, 0);
        if (shapeOf(now) == shapeOf(before)) {
            ++refits;
            EXPECT_LE(now.stats.sahCost, 1.5 * built);
            EXPECT_EQ(now.stats.buildSeconds, before.stats.buildSeconds);
        } else {
            ++builds;
            built = now.stats.sahCost;
        }
        before = now;
    }
    EXPECT_GE(builds, 1);
    EXPECT_GE(refits, 5 * builds);
    // Shuffled: nothing is where it was.
    Mesh shuffled = rest;
    Random random(9);
    for (size_t v = shuffled.positions.size(); v-- > 1;)
        std::swap(shuffled.positions[v], shuffled.positions[size_t(random.between(0, float(v)))]);
    const double dear = bvh.at(inputOf(shuffled)).stats.sahCost;
    EXPECT_LT(bvh.at(inputOf(rest)).stats.sahCost, 1.5 * dear);
    scene::MovingBvh fresh(inputOf(shuffled), ANY_SIZE);
    EXPECT_LT(dear, 1.2 * fresh.at(inputOf(shuffled)).stats.sahCost);
}

TEST(MovingBvh, OfWhatIsHiddenAtRestIsGoodOnceItIsShown)
{
    const Mesh shown = tubes();
    Mesh nothing = hidden(shown);
    nothing.positions.assign(nothing.positions.size(), glm::vec3(0));
    for (scene::Triangle& triangle : nothing.triangles) triangle.vertices.fill(0);
    scene::MovingBvh fresh(inputOf(shown), ANY_SIZE);
    const Bvh good = fresh.at(inputOf(shown));
    for (const Mesh& rest : {nothing, hidden(shown), shrunkToAPoint(shown)}) {
        scene::MovingBvh bvh(inputOf(rest), ANY_SIZE);
        EXPECT_TRUE(std::isfinite(bvh.at(inputOf(rest)).stats.sahCost));
        EXPECT_LT(bvh.at(inputOf(shown)).stats.sahCost, 1.5 * good.stats.sahCost);
        EXPECT_LE(bvh.most().depth, fresh.most().depth + 2); // the stack's size, for all poses
        EXPECT_LE(bvh.most().nodeRows, 2 * fresh.most().nodeRows);
    }
}

// Flat at rest, and then a chain of triangles each smaller than the one before, whose best tree is deeper than there
// is room for: the old one serves.
TEST(MovingBvh, WithoutRoomForABetterTreeGoesOnWithTheOldOne)
{
    constexpr uint32_t COUNT = 400;
    Mesh rest, chain;
    for (uint32_t i = 0; i < COUNT; ++i) {
        const glm::vec3 p(float(i * 37 % COUNT % 20), float(i * 37 % COUNT / 20), 0);
        rest.add(p, p + glm::vec3(0.5f, 0, 0), p + glm::vec3(0, 0.5f, 0));
        const float s = std::pow(0.93f, float(i));
        chain.add({s, 0, 0}, {s, s, 0}, {s, 0, s});
    }
    scene::MovingBvh bvh(inputOf(rest), ANY_SIZE), fresh(inputOf(chain), ANY_SIZE);
    const Bvh flat = bvh.at(inputOf(rest)), deep = fresh.at(inputOf(chain));
    ASSERT_GT(deep.stats.depth, bvh.most().depth);
    const Bvh worn = bvh.at(inputOf(chain));
    EXPECT_EQ(shapeOf(worn), shapeOf(flat));
    EXPECT_GT(worn.stats.sahCost, 1.5 * flat.stats.sahCost);
    expectHolds(worn, chain, bvh.most());
    EXPECT_EQ(shapeOf(bvh.at(inputOf(rest))), shapeOf(flat));
}

// Pairs that came apart leave no old tree to go on with; the one before is still there for the next pose.
TEST(MovingBvh, ThatIsTornWithoutRoomIsAnError)
{
    Mesh rest, chain;
    for (uint32_t i = 0; i < 400; ++i) {
        const auto add = [&](Mesh& mesh, glm::vec3 p, float size, bool tear) {
            const uint32_t v = uint32_t(mesh.positions.size());
            for (const glm::vec3& corner : {glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(1, 1, 0), glm::vec3(0, 1, 0)})
                mesh.positions.push_back(p + size * corner);
            mesh.triangles.push_back({.vertices = {v, v + 1, v + 2}});
            mesh.triangles.push_back({.vertices = {v, tear ? v + 3 : v + 2, tear ? v + 2 : v + 3}});
        };
        add(rest, {float(i % 20), float(i / 20), 0}, 0.5f, false);
        const float s = std::pow(0.93f, float(i));
        add(chain, {s, 0, s}, s, true);
    }
    scene::MovingBvh bvh(inputOf(rest), ANY_SIZE), fresh(inputOf(chain), ANY_SIZE);
    const Bvh flat = bvh.at(inputOf(rest));
    ASSERT_EQ(flat.stats.triangleRecords, 400u);
    ASSERT_GT(fresh.at(inputOf(chain)).stats.depth, bvh.most().depth);
    EXPECT_THROW(bvh.at(inputOf(chain)), Error);
    EXPECT_EQ(bvh.at(inputOf(rest)).triangles, flat.triangles);
    EXPECT_EQ(bvh.at(inputOf(rest)).nodes, flat.nodes);
}

TEST(MovingBvh, MayBeOfNothingOrOfOneTriangle)
{
    Mesh none, one;
    one.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    for (const Mesh& mesh : {none, one}) {
        scene::MovingBvh bvh(inputOf(mesh), ANY_SIZE);
        for (const float way : {0.0f, 5.0f, 0.0f}) {
            Mesh pose = mesh;
            for (glm::vec3& p : pose.positions) p.z += way;
            const Bvh moved = bvh.at(inputOf(pose));
            expectHolds(moved, pose, bvh.most());
            EXPECT_EQ(reachable(moved).size(), mesh.triangles.size());
        }
        if (mesh.triangles.empty()) continue;
        Mesh point = mesh;
        point.triangles[0].vertices.fill(0);
        EXPECT_EQ(bvh.at(inputOf(point)).stats.sahCost, 0);
        expectHolds(bvh.at(inputOf(mesh)), mesh, bvh.most());
    }
}

TEST(MovingBvh, ThatDoesNotFitIsAnError)
{
    const Mesh mesh = tubes();
    const auto bytes = [](uint32_t rows) { return uint64_t{rows} * sizeof(glm::uvec4); };
    const scene::MovingBvh::Most most = scene::MovingBvh(inputOf(mesh), ANY_SIZE).most();
    const uint64_t least = std::max(bytes(most.nodeRows), bytes(most.recordRows));
    EXPECT_NO_THROW(scene::MovingBvh(inputOf(mesh), least));
    EXPECT_THROW(scene::MovingBvh(inputOf(mesh), least - 1), Error);
}

TEST(MovingBvh, ReportsProgressThatGrowsToOne)
{
    const Mesh mesh = tubes();
    std::vector<double> reports;
    const scene::MovingBvh bvh({.positions = mesh.positions,
                                .triangles = mesh.triangles,
                                .progress = [&](double fraction) { reports.push_back(fraction); }},
                               ANY_SIZE);
    EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
    ASSERT_FALSE(reports.empty());
    EXPECT_EQ(reports.back(), 1.0);
}

} // namespace
