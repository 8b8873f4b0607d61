// Trees of triangles that move, in every pose against brute force.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/scene/bvh.h"
#include "tests/engine/scene/bvh_reading.h"
#include "tests/support/random_points.h"

namespace
{

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
