// Traversal on the device against Embree's own, and what it promises about ties, alpha, limits and odd rays.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <random>

#include <fmt/core.h>

#include "engine/scene/gltf_loader.h"
#include "engine/scene/procedural.h"
#include "engine/scene/shapes.h"
#include "tests/shaders/scene/intersect_fixture.h"

namespace
{

// ------------------------------------------------------------------------------------------------- agreement with
// Embree

// One triangle met by one ray in float64: t, and how far inside it the ray passes (negative: outside), as the smallest
// barycentric and as the distance of the ray from the nearest edge.
struct Exact {
    double t = 0;
    double inside = 0;
    double fromEdge = 0;
};

Exact meet(const Mesh& mesh, uint32_t triangle, const TestRay& ray)
{
    const auto& index = mesh.triangles[triangle].vertices;
    const glm::dvec3 v0 = mesh.positions[index[0]], v1 = mesh.positions[index[1]], v2 = mesh.positions[index[2]];
    const glm::dvec3 e1 = v1 - v0, e2 = v2 - v0, direction = ray.direction, s = glm::dvec3(ray.origin) - v0;
    const glm::dvec3 p = glm::cross(direction, e2), q = glm::cross(s, e1);
    const double determinant = glm::dot(e1, p);
    const double u = glm::dot(s, p) / determinant, v = glm::dot(direction, q) / determinant;
    const auto distance = [&](double weight, const glm::dvec3& edge) {
        return weight * std::abs(determinant) / glm::length(glm::cross(direction, edge));
    };
    return {.t = glm::dot(e2, q) / determinant,
            .inside = std::min({u, v, 1 - u - v}),
            .fromEdge = std::min({distance(u, e2), distance(v, e1), distance(1 - u - v, e2 - e1)})};
}

// Why two tracers may see different triangles: the nearer one's edge is so near that either answer is right to float
// precision, or both are met at the same distance, or the nearer one where the ray begins, before or behind.
enum class Reason { Edge, Tie, Origin, None };

Reason reasonFor(const Mesh& mesh, const TestRay& ray, const Hit& ours, const RTCRayHit& theirs)
{
    // What rounding may move a point at distance t along the ray: a few units in the last place of its coordinates.
    const glm::vec3 origin = glm::abs(ray.origin);
    const auto rounding = [&](const Exact& e) {
        return std::ldexp(std::max({origin.x, origin.y, origin.z}) + std::abs(e.t), -22);
    };
    const auto nearEdge = [&](const Exact& e) {
        return std::abs(e.inside) <= 1e-4 || std::abs(e.fromEdge) <= rounding(e);
    };
    const bool weHit = ours.isHit(), theyHit = theirs.hit.primID != RTC_INVALID_GEOMETRY_ID;
    const Exact none = {.t = std::numeric_limits<double>::infinity()};
    const Exact our = weHit ? meet(mesh, ours.triangle(), ray) : none;
    const Exact their = theyHit ? meet(mesh, theirs.hit.primID, ray) : none;
    if (weHit && our.inside < 0 && !nearEdge(our)) return Reason::None; // we claim a hit that is none
    if (weHit && theyHit && std::abs(our.t - their.t) <= 1e-5 * their.t) return Reason::Tie;
    const Exact& nearer = our.t < their.t ? our : their;
    if (std::abs(nearer.t) <= rounding(nearer)) return Reason::Origin;
    return nearEdge(nearer) ? Reason::Edge : Reason::None;
}

// A ray that nothing explains: all that it takes to look into it.
void describe(const Mesh& mesh, const TestRay& ray, const Hit& ours, const RTCRayHit& theirs)
{
    fmt::print("unexplained: from ({:.9g}, {:.9g}, {:.9g}) along ({:.9g}, {:.9g}, {:.9g})\n", ray.origin.x,
               ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z);
    const auto hit = [&](const char* whose, uint32_t triangle, float t) {
        if (triangle == NO_HIT) {
            fmt::print("  {}: none\n", whose);
            return;
        }
        const Exact exact = meet(mesh, triangle, ray);
        fmt::print("  {}: triangle {} at t {:.9g}; exactly {:.9g}, inside by {:.3g}, from an edge {:.3g}\n", whose,
                   triangle, t, exact.t, exact.inside, exact.fromEdge);
    };
    hit("ours", ours.triangle(), ours.t);
    hit("Embree's", theirs.hit.primID == RTC_INVALID_GEOMETRY_ID ? NO_HIT : theirs.hit.primID, theirs.ray.tfar);
}

// How far the point that a hit's barycentrics name is from the ray.
double distanceFromRay(const Mesh& mesh, const Hit& hit, const TestRay& ray)
{
    const auto& index = mesh.triangles[hit.triangle()].vertices;
    const double u = hit.u, v = hit.v;
    const glm::dvec3 point = (1 - u - v) * glm::dvec3(mesh.positions[index[0]]) +
                             u * glm::dvec3(mesh.positions[index[1]]) + v * glm::dvec3(mesh.positions[index[2]]);
    return glm::length(glm::cross(point - glm::dvec3(ray.origin), glm::dvec3(ray.direction)));
}

// For each triangle the lowest index of its copies: Sponza has some hundreds, and Embree reports any of them.
std::vector<uint32_t> firstCopies(const Mesh& mesh)
{
    using Key = std::array<float, 9>;
    std::map<Key, uint32_t> firstOf;
    std::vector<uint32_t> first;
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        std::array<std::array<float, 3>, 3> corners;
        for (size_t k = 0; k < 3; ++k) {
            const glm::vec3 p = mesh.positions[mesh.triangles[i].vertices[k]];
            corners[k] = {p.x, p.y, p.z};
        }
        std::sort(corners.begin(), corners.end());
        first.push_back(firstOf.emplace(std::bit_cast<Key>(corners), i).first->second);
    }
    return first;
}

class IntersectAgreement : public Intersect
{
  protected:
    void expectAgreement(const scene::Scene& scene, uint32_t size)
    {
        const Mesh mesh = {.positions = scene.positions, .triangles = scene.triangles};
        const EmbreeScene embree(scene.positions, scene.triangles);
        const RaySets sets = makeRaySets(scene, embree, size);
        std::vector<TestRay> rays = sets.camera;
        rays.insert(rays.end(), sets.bounce.begin(), sets.bounce.end());
        rays.insert(rays.end(), sets.shadow2.begin(), sets.shadow2.end());
        rays.insert(rays.end(), sets.bounce2.begin(), sets.bounce2.end());
        const std::vector<Hit> hits = trace(mesh, rays);
        const std::vector<uint32_t> firstCopy = firstCopies(mesh);
        float magnitude = 0;
        for (const glm::vec3& p : scene.positions)
            magnitude = std::max({magnitude, std::abs(p.x), std::abs(p.y), std::abs(p.z)});

        size_t hitCount = 0, astray = 0, edges = 0, ties = 0, roundings = 0, unexplained = 0, occlusionDiffers = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const RTCRayHit theirs = embree.intersect(rays[i]);
            occlusionDiffers += hits[i].occluded() != hits[i].isHit() ? 1 : 0;
            const bool theyHit = theirs.hit.primID != RTC_INVALID_GEOMETRY_ID;
            const uint32_t primitive = theyHit ? firstCopy[theirs.hit.primID] : NO_HIT;
            hitCount += primitive != NO_HIT ? 1 : 0;
            if (primitive == hits[i].triangle()) {
                if (primitive == NO_HIT) continue;
                astray += distanceFromRay(mesh, hits[i], rays[i]) > 1e-5 * double(magnitude) ? 1 : 0;
                const double difference = std::abs(double(hits[i].t) - theirs.ray.tfar);
                if (difference <= 1e-4 * theirs.ray.tfar) continue;
                // A hit so near that the rounding of coordinates is a larger part of t.
                if (difference <= 1e-6 * magnitude) {
                    ++roundings;
                    continue;
                }
            } else {
                const Reason reason = reasonFor(mesh, rays[i], hits[i], theirs);
                edges += reason == Reason::Edge ? 1 : 0;
                ties += reason == Reason::Tie ? 1 : 0;
                roundings += reason == Reason::Origin ? 1 : 0;
                if (reason != Reason::None) continue;
            }
            ++unexplained;
            describe(mesh, rays[i], hits[i], theirs);
        }
        const double agreement = 1.0 - double(edges + ties + roundings + unexplained) / double(rays.size());
        fmt::print("{} rays, {} hits, agreement {:.6f}; differing: {} at edges, {} ties, {} by rounding at the origin, "
                   "{} unexplained; {} points off their rays\n",
                   rays.size(), hitCount, agreement, edges, ties, roundings, unexplained, astray);
        EXPECT_GT(hitCount, rays.size() / 2);
        EXPECT_GE(agreement, 0.9999);
        EXPECT_EQ(unexplained, 0u);
        EXPECT_LE(astray, hitCount / 100000 + 1) << "barycentrics of other points; of slivers seen edge-on they may be";
        EXPECT_EQ(occlusionDiffers, 0u);
    }
};

TEST_F(IntersectAgreement, WithEmbreeInTheHall)
{
    expectAgreement(scene::makeHall(), 256);
}

TEST_F(IntersectAgreement, WithEmbreeInSponza)
{
    const std::filesystem::path file =
        std::filesystem::path(TRICHROME_SOURCE_DIR) / "../shared/scenes/sponza/sponza_curtain_spots.gltf";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "SKIPPED, NOT TESTED: " << file << " is missing";
    const char* size = std::getenv("TRICHROME_TEST_RAYS"); // 512: the million rays of tests/bench/LOG.md
    expectAgreement(scene::loadGltf(file), size ? uint32_t(std::atoi(size)) : 256u);
}

// --------------------------------------------------------------------------------------------------------------
// promises

// A deep tree of a chain of triangles, each half as large and half as far, and a wide one: with the stack that fits, in
// registers and in an array, and with the largest.
TEST_F(Intersect, FindsTheSameWithEveryStack)
{
    Mesh chain;
    std::vector<TestRay> rays;
    for (int i = 0; i < 120; ++i) {
        const float s = std::ldexp(1.0f, 40 - i);
        chain.add({s, 0, 0}, {s, s, 0}, {s, 0, s});
        rays.push_back({{1.5f * s, 0.25f * s, 0.25f * s}, FAR, {-1, 0, 0}});
        rays.push_back({{0.75f * s, 0.25f * s, 0.25f * s}, FAR, {1, 0, 0}});
    }
    const scene::Scene hall = scene::makeHall();
    const EmbreeScene embree(hall.positions, hall.triangles);
    const RaySets sets = makeRaySets(hall, embree, 64);
    const Mesh wide = {.positions = hall.positions, .triangles = hall.triangles};

    for (const auto& [mesh, all] :
         {std::pair(&std::as_const(chain), &std::as_const(rays)), std::pair(&wide, &sets.bounce)}) {
        const uint32_t depth =
            scene::buildBvh({.positions = mesh->positions, .triangles = mesh->triangles}, device().limits().tableBytes)
                .stats.depth;
        forcedStack = scene::TraversalStack{shared::BVH_STACK_SIZE, false};
        const std::vector<Hit> expected = trace(*mesh, *all);
        EXPECT_GT(std::ranges::count_if(expected, &Hit::isHit), std::ptrdiff_t(all->size() / 2));
        for (const bool inRegisters : {false, true}) {
            forcedStack = scene::TraversalStack{depth, inRegisters};
            const std::vector<Hit> hits = trace(*mesh, *all);
            size_t differing = 0;
            for (size_t i = 0; i < hits.size(); ++i) differing += hits[i] != expected[i] ? 1 : 0;
            EXPECT_EQ(differing, 0u) << depth << " entries, in registers: " << inRegisters;
        }
    }
}

// A tree that was refitted finds what one finds that was built where the triangles are now: a ball moved, mirrored,
// shrunk to a point, with holes, and back, in the hall.
TEST_F(Intersect, FindsTheSameInATreeThatWasRefitted)
{
    scene::Scene hall = scene::makeHall();
    const size_t ball = hall.triangles.size(), vertices = hall.positions.size();
    scene::addSphere(hall, 0, {0, 1.5f, 0}, 0.8f, 4);
    const Mesh rest = {.positions = hall.positions, .triangles = hall.triangles};
    const auto posed = [&](auto&& place, auto&& change) {
        Mesh mesh = rest;
        for (size_t v = vertices; v < mesh.positions.size(); ++v) mesh.positions[v] = place(mesh.positions[v]);
        for (size_t t = ball; t < mesh.triangles.size(); ++t) change(t, mesh.triangles[t].vertices);
        return mesh;
    };
    using Vertices = std::array<uint32_t, 3>;
    const auto stay = [](glm::vec3 p) { return p; };
    const auto keep = [](size_t, Vertices&) {};
    const auto vanish = [](size_t, Vertices& v) { v.fill(v[0]); };
    const auto mirror = [](size_t, Vertices& v) { std::swap(v[1], v[2]); };
    const Mesh poses[] = {posed([](glm::vec3 p) { return p + glm::vec3(1, 0.3f, 1); }, keep),
                          posed([](glm::vec3 p) { return glm::vec3(-p.x, p.y, p.z); }, mirror),
                          posed([](glm::vec3) { return glm::vec3(1); }, vanish),
                          posed(stay, [&](size_t t, Vertices& v) { t % 3 == 0 ? vanish(t, v) : keep(t, v); }),
                          posed([](glm::vec3 p) { return p * (1.0f + 0.4f * std::sin(9 * p.x)); }, keep),
                          rest};
    scene::MovingBvh bvh(inputOf(rest), device().limits().tableBytes);
    for (const Mesh& mesh : poses) {
        const RaySets sets = makeRaySets(hall, EmbreeScene(mesh.positions, mesh.triangles), 64);
        size_t onBall = 0;
        for (const std::vector<TestRay>* rays : {&sets.camera, &sets.bounce, &sets.shadow2}) {
            const std::vector<Hit> expected = trace(mesh, *rays), hits = trace(mesh, bvh.at(inputOf(mesh)), *rays);
            size_t different = 0;
            for (size_t i = 0; i < hits.size(); ++i) {
                different += hits[i].packed != expected[i].packed;
                onBall += hits[i].isHit() && hits[i].triangle() >= ball;
                EXPECT_EQ(hits[i].isHit(), hits[i].occluded());
                if (hits[i].isHit() && hits[i].triangle() == expected[i].triangle()) {
                    EXPECT_NEAR(hits[i].t, expected[i].t, 1e-5f * (1 + expected[i].t));
                }
            }
            EXPECT_LE(different, hits.size() / 2000); // at edges: advanced origins differ with the trees' boxes
        }
        EXPECT_EQ(onBall > 0, &mesh != &poses[2]);
    }
}

TEST_F(Intersect, OfNothingIsNothing)
{
    const std::vector<Hit> hits = trace({}, {{{0, 0, 0}, FAR, {0, 0, 1}}, {{1e6f, 0, 0}, FAR, {-1, 0, 0}}});
    for (const Hit& hit : hits) EXPECT_FALSE(hit.isHit() || hit.occluded());
}

TEST_F(Intersect, GivesPositionByBarycentricsAndDistance)
{
    Mesh mesh;
    mesh.add({0, 0, 2}, {1, 0, 2}, {0, 1, 2});
    const Hit hit = trace(mesh, {{{0.25f, 0.5f, 0}, FAR, {0, 0, 1}}})[0];
    EXPECT_EQ(hit.triangle(), 0u);
    EXPECT_NEAR(hit.u, 0.25f, 1e-6f);
    EXPECT_NEAR(hit.v, 0.5f, 1e-6f);
    EXPECT_NEAR(hit.t, 2.0f, 1e-6f);
}

// Two triangles in one record, folded so that some rays meet both, each beginning with each of its vertices.
TEST_F(Intersect, MeetsTheNearerOfAPairWhateverTheirOrderOfVertices)
{
    const glm::vec3 a = {0, 0, 0}, b = {0, 1, 0}, c = {1, 0.5f, 0.25f}, d = {0.9f, 0.5f, -0.25f};
    std::mt19937 engine(6);
    std::uniform_real_distribution<float> place(-0.2f, 1.2f);
    for (size_t turn = 0; turn < 9; ++turn) {
        std::array<glm::vec3, 3> first = {a, b, c}, second = {b, a, d};
        std::rotate(first.begin(), first.begin() + std::ptrdiff_t(turn % 3), first.end());
        std::rotate(second.begin(), second.begin() + std::ptrdiff_t(turn / 3), second.end());
        Mesh mesh;
        mesh.add(first[0], first[1], first[2]);
        mesh.add(second[0], second[1], second[2]);
        ASSERT_EQ(
            scene::buildBvh({.positions = mesh.positions, .triangles = mesh.triangles}, ~0ull).stats.triangleRecords,
            1u);
        std::vector<TestRay> rays;
        for (int i = 0; i < 4000; ++i) {
            // From either side, and from between the two.
            const glm::vec3 from = {0.5f * place(engine), place(engine), std::array{-1.0f, 0.0f, 1.0f}[size_t(i) % 3]};
            const glm::vec3 to = {place(engine), place(engine), from.z == 0 ? place(engine) - 0.5f : 0.0f};
            rays.push_back({from, i % 4 == 0 ? 1.0f : FAR, glm::normalize(to - from)});
        }
        const std::vector<Hit> hits = trace(mesh, rays);
        std::array<int, 3> counts = {}; // of either triangle as the nearest; of both met
        for (size_t i = 0; i < rays.size(); ++i) {
            std::array<Exact, 2> exact = {meet(mesh, 0, rays[i]), meet(mesh, 1, rays[i])};
            bool atAnEdge = false;
            std::array<bool, 2> met = {};
            for (size_t k = 0; k < 2; ++k) {
                met[k] = exact[k].inside >= 0 && exact[k].t > 0 && exact[k].t < double(rays[i].tMax);
                atAnEdge = atAnEdge || std::abs(exact[k].inside) < 1e-4 || std::abs(exact[k].t) < 1e-4 ||
                           std::abs(exact[k].t - double(rays[i].tMax)) < 1e-4;
            }
            if (atAnEdge) continue;
            ASSERT_EQ(hits[i].isHit(), met[0] || met[1]) << i;
            ASSERT_EQ(hits[i].occluded(), met[0] || met[1]) << i;
            if (!hits[i].isHit()) continue;
            const size_t nearer = met[0] && (!met[1] || exact[0].t < exact[1].t) ? 0 : 1;
            ASSERT_EQ(hits[i].triangle(), nearer) << i;
            EXPECT_NEAR(double(hits[i].t), exact[nearer].t, 1e-5);
            EXPECT_LT(distanceFromRay(mesh, hits[i], rays[i]), 2e-6) << "turns " << turn % 3 << ", " << turn / 3;
            ++counts[nearer];
            counts[2] += met[0] && met[1] ? 1 : 0;
        }
        for (const int count : counts) EXPECT_GT(count, 50);
    }
}

TEST_F(Intersect, EndsAtTMax)
{
    Mesh mesh;
    mesh.add({-1, -1, 2}, {1, -1, 2}, {0, 1, 2});
    const std::vector<Hit> hits = trace(mesh, {{{0, 0, 0}, 1.999f, {0, 0, 1}},
                                               {{0, 0, 0}, 2.001f, {0, 0, 1}},
                                               {{0, 0, -1e4f}, 1e4f + 1.9f, {0, 0, 1}},
                                               {{0, 0, -1e4f}, 1e4f + 2.1f, {0, 0, 1}}});
    for (size_t i = 0; i < hits.size(); ++i) {
        EXPECT_EQ(hits[i].isHit(), i % 2 == 1) << i;
        EXPECT_EQ(hits[i].occluded(), i % 2 == 1) << i;
    }
}

// The same triangles in another order are another tree: the lowest index must win in both.
TEST_F(Intersect, ResolvesTiesToTheLowestIndex)
{
    constexpr uint32_t LAYERS = 40;
    std::mt19937 engine(5);
    Mesh mesh;
    for (uint32_t i = 0; i < LAYERS; ++i) { // one plane, overlapping triangles
        std::uniform_real_distribution<float> jitter(-0.2f, 0.2f);
        mesh.add({-2 + jitter(engine), -2, 1}, {2 + jitter(engine), -2, 1}, {jitter(engine), 2 + jitter(engine), 1});
    }
    for (uint32_t i = 0; i < LAYERS; ++i) mesh.triangles.push_back(mesh.triangles[i]); // and each of them again
    std::vector<TestRay> rays;
    std::uniform_real_distribution<float> inside(-0.5f, 0.5f);
    for (int i = 0; i < 1000; ++i) rays.push_back({{inside(engine), inside(engine), -1}, FAR, {0, 0, 1}});
    const std::vector<Hit> hits = trace(mesh, rays);
    for (const Hit& hit : hits) EXPECT_EQ(hit.triangle(), 0u);

    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), engine);
    for (const Hit& hit : trace(mesh, rays)) EXPECT_EQ(hit.triangle(), 0u);
}

// Alpha-tested layers are passed one by one within a single traversal. A driver that cuts loops short would lose the
// wall behind them: lavapipe 22.3 leaves every loop after 65 535 iterations of all loops of an invocation together. The
// kernel traces each ray twice, and a layer takes an iteration of each of four loops.
TEST_F(Intersect, PassesThroughManyTransparentLayers)
{
    constexpr uint32_t LAYERS = 7000;
    Mesh mesh;
    for (uint32_t i = 0; i <= LAYERS; ++i) {
        const float z = 1 + 1e-3f * float(i);
        mesh.add({-1, -1, z}, {1, -1, z}, {0, 1, z});
    }
    mesh.needsAlphaTest.assign(LAYERS + 1, 1);
    mesh.needsAlphaTest.back() = 0;
    mesh.solid.assign(LAYERS + 1, 0);
    mesh.solid[LAYERS] = 0; // not asked: its flag is not set
    std::vector<TestRay> rays = {{{0, 0, 0}, FAR, {0, 0, 1}}, {{0, 0, 100}, FAR, {0, 0, -1}}};
    for (const Hit& hit : trace(mesh, rays)) {
        EXPECT_EQ(hit.triangle(), LAYERS);
        EXPECT_TRUE(hit.occluded());
    }
    mesh.solid[700] = 1;
    const std::vector<Hit> hits = trace(mesh, rays);
    EXPECT_EQ(hits[0].triangle(), 700u);
    EXPECT_EQ(hits[1].triangle(), LAYERS);
    rays[0].tMax = 1.5f;
    EXPECT_FALSE(trace(mesh, rays)[0].occluded());
}

// Half of the hall's triangles are asked for their alpha, and half of those let rays pass: as if they were not there.
TEST_F(Intersect, PassesThroughWhatIsTransparentAsIfItWereNotThere)
{
    const scene::Scene hall = scene::makeHall();
    const EmbreeScene embree(hall.positions, hall.triangles);
    const RaySets sets = makeRaySets(hall, embree, 128);
    Mesh asked = {.positions = hall.positions, .triangles = hall.triangles};
    Mesh without = asked;
    asked.solid.clear();
    std::mt19937 random(3);
    for (scene::Triangle& triangle : without.triangles) {
        const uint32_t bits = uint32_t(random());
        asked.needsAlphaTest.push_back(bits & 1u);
        asked.solid.push_back(bits >> 1 & 1u);
        if ((bits & 3u) == 1u) triangle.vertices.fill(triangle.vertices[0]); // degenerate: left out of the tree
    }
    for (const std::vector<TestRay>* rays : {&sets.camera, &sets.bounce, &sets.shadow2}) {
        const std::vector<Hit> expected = trace(without, *rays);
        const std::vector<Hit> hits = trace(asked, *rays);
        size_t solid = 0, different = 0;
        for (size_t i = 0; i < hits.size(); ++i) {
            different += hits[i].packed != expected[i].packed ? 1 : 0;
            solid += hits[i].isHit() && asked.needsAlphaTest[hits[i].triangle()] != 0 ? 1 : 0;
            EXPECT_EQ(hits[i].isHit(), hits[i].occluded());
        }
        EXPECT_GT(solid, hits.size() / 8);        // those that were asked
        EXPECT_LE(different, hits.size() / 5000); // at edges: the trees' boxes differ, and so do the advanced origins
    }
}

TEST_F(Intersect, OfManyEqualTrianglesEnds)
{
    Mesh mesh;
    for (int i = 0; i < 2000; ++i) mesh.add({0, 0, 1}, {1, 0, 1}, {0, 1, 1});
    const std::vector<Hit> hits = trace(mesh, {{{0.2f, 0.2f, 0}, FAR, {0, 0, 1}}, {{0.9f, 0.9f, 0}, FAR, {0, 0, 1}}});
    EXPECT_EQ(hits[0].triangle(), 0u);
    EXPECT_FALSE(hits[1].isHit());
}

// Directions with zero components, of either sign, also in the planes of boxes and of triangles' edges.
TEST_F(Intersect, MeetsAGridAlongItsAxes)
{
    constexpr int SIZE = 16;
    std::vector<TestRay> rays;
    for (int axis = 0; axis < 3; ++axis) {
        Mesh mesh;
        rays.clear();
        const auto at = [&](int i, int j, float depth) {
            glm::vec3 p;
            p[axis] = depth;
            p[(axis + 1) % 3] = float(i) / SIZE;
            p[(axis + 2) % 3] = float(j) / SIZE;
            return p;
        };
        for (int i = 0; i < SIZE; ++i)
            for (int j = 0; j < SIZE; ++j) {
                mesh.add(at(i, j, 0), at(i + 1, j, 0), at(i, j + 1, 0));
                mesh.add(at(i + 1, j, 0), at(i + 1, j + 1, 0), at(i, j + 1, 0));
            }
        for (const float zero : {0.0f, -0.0f})
            for (const float side : {-1.0f, 1.0f})
                for (int i = 0; i <= 2 * SIZE; ++i)
                    for (int j = 0; j <= 2 * SIZE; ++j) {
                        TestRay ray = {0.5f * at(i, j, 2 * side), FAR, glm::vec3(zero)};
                        ray.direction[axis] = -side;
                        rays.push_back(ray); // through cells, edges and vertices, the mesh's border included
                    }
        const std::vector<Hit> hits = trace(mesh, rays);
        for (size_t i = 0; i < hits.size(); ++i) {
            ASSERT_TRUE(hits[i].isHit() && hits[i].occluded()) << "axis " << axis << " ray " << i;
            ASSERT_FLOAT_EQ(hits[i].t, 1.0f);
        }
        for (TestRay& ray : rays) std::swap(ray.direction[axis], ray.direction[(axis + 1) % 3]); // beside the plane
        for (const Hit& hit : trace(mesh, rays)) ASSERT_FALSE(hit.isHit() || hit.occluded());
    }
}

} // namespace
