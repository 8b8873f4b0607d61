// What moves in hunted cases: poses frame by frame, in files, and in cases that are made smaller.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "engine/scene/shapes.h"
#include "tests/hunt/case_file.h"
#include "tests/hunt/shrink.h"

namespace hunt
{
namespace
{

bool looksAlike(const scene::Scene& a, const scene::Scene& b)
{
    const auto same = [](const scene::Material& m, const scene::Material& n) {
        return m.baseColor == n.baseColor && m.emission == n.emission && m.roughness == n.roughness &&
               m.metallic == n.metallic;
    };
    const auto alike = [](const scene::PunctualLight& m, const scene::PunctualLight& n) {
        return m.position == n.position && m.direction == n.direction && m.intensity == n.intensity;
    };
    return std::ranges::equal(a.materials, b.materials, same) && std::ranges::equal(a.lights, b.lights, alike);
}

TEST(MovingCases, Move)
{
    std::map<std::string, size_t> seen;
    size_t moving = 0;
    for (uint64_t index = 0; index < 200; ++index) {
        const Case c = Session(6, index, {.kind = "moving"}).draw(index % SESSION_CASES);
        EXPECT_TRUE(c.settings.temporal);
        EXPECT_EQ(c.truth, Truth::PathTracer);
        ASSERT_FALSE(c.moves.empty());
        for (const Move& move : c.moves) ++seen[WHAT_NAMES[size_t(move.what)]], ++seen[WHEN_NAMES[size_t(move.when)]];
        const scene::Scene last = c.sceneIn(c.settings.frames - 1), before = c.sceneIn(c.settings.frames - 2);
        moving += last.positions != before.positions || !looksAlike(last, before);
        EXPECT_EQ(last.triangles.size(), c.scene.triangles.size());
        for (const glm::vec3& p : last.positions) EXPECT_TRUE(std::isfinite(glm::dot(p, p))) << c.describe();
        for (const glm::vec3& n : last.normals) EXPECT_NEAR(glm::length(n), 1, 1e-3) << c.describe();
    }
    EXPECT_GT(moving, 100u); // in the last step; the others have moved before
    for (const char* name : WHAT_NAMES) EXPECT_GT(seen[name], 5u) << name;
    for (const char* name : WHEN_NAMES) EXPECT_GT(seen[name], 5u) << name;
}

// What has passed when a history of half the length begins does not count.
TEST(MovingCases, EndWithTheSameSceneWhereTheirHistoryIsShorter)
{
    for (uint64_t index = 0; index < 50; ++index) {
        Case c = Session(6, index, {.kind = "moving"}).draw(0);
        const scene::Scene last = c.sceneIn(c.settings.frames - 1), before = c.sceneIn(c.settings.frames - 2);
        c.settings.frames = 2;
        EXPECT_EQ(c.sceneIn(1).positions, last.positions);
        EXPECT_EQ(c.sceneIn(0).positions, before.positions);
    }
}

TEST(Moves, TakeTheirTime)
{
    using enum Move::When;
    const auto history = [](Move move) { // the oldest first
        std::vector<float> amounts;
        for (uint32_t framesAgo = 4; framesAgo-- > 0;) amounts.push_back(move.amount(framesAgo));
        return amounts;
    };
    EXPECT_EQ(history({.when = Steady}), (std::vector<float>{0.6f, 0.4f, 0.2f, 0}));
    EXPECT_EQ(history({.when = InTurn}), (std::vector<float>{1, 0, 1, 0}));
    EXPECT_EQ(history({.when = InTurn, .reversed = true}), (std::vector<float>{0, 1, 0, 1}));
    EXPECT_EQ(history({.when = Until, .frames = 2}), (std::vector<float>{1, 1, 0, 0}));
    EXPECT_EQ(history({.when = Once, .frames = 2}), (std::vector<float>{0, 1, 0, 0}));
}

TEST(Moves, ChangeWhatTheyName)
{
    scene::Scene rest;
    const uint32_t wall = scene::addMaterial(rest, scene::diffuse("wall", glm::vec3(0.5f)));
    const uint32_t lamp = scene::addMaterial(rest, scene::emitter("lamp", {4, 2, 0}));
    scene::addQuad(rest, wall, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
    scene::addQuad(rest, lamp, {-1, 2, -1}, {2, 0, 0}, {0, 0, 2});
    rest.lights.push_back({.intensity = {1, 2, 3}, .position = {0, 1, 0}});
    using enum Move::What;
    const auto after = [&](const Move& move) { return posed(rest, {move}, 1); }; // InTurn: wholly
    const auto corner = [](const scene::Scene& s, size_t t, size_t i) {
        return s.positions[s.triangles[t].vertices[i]];
    };
    const auto isNear = [](const glm::vec3& a, const glm::vec3& b) { return glm::distance(a, b) < 1e-5f; };

    // The lamp doubles in x about its middle, turns by a right angle about y, and rises: a mirror changes the corners.
    const Move carry{.what = Place,
                     .target = lamp,
                     .center = {0, 2, 0},
                     .slide = {0, 1, 0},
                     .turn = {0, float(std::numbers::pi / 2), 0},
                     .stretch = {-2, 1, 1}};
    const scene::Scene carried = after(carry);
    for (size_t t = 0; t < 2; ++t)
        for (size_t i = 0; i < 3; ++i) {
            EXPECT_EQ(corner(carried, t, i), corner(rest, t, i));
            const glm::vec3 p = corner(rest, 2 + t, i);
            const size_t mirrored = (3 - i) % 3;
            EXPECT_TRUE(isNear(corner(carried, 2 + t, mirrored), glm::vec3(p.z, 3, 2 * p.x))) << t << " " << i;
        }

    EXPECT_EQ(corner(after({.what = Hide, .target = lamp}), 2, 1), corner(after({.what = Hide, .target = lamp}), 3, 2));
    const scene::Scene wobbled = after({.what = Wobble, .target = wall, .slide = {0, 0.5f, 0}, .turn = {2, 0, 0}});
    EXPECT_NE(corner(wobbled, 0, 0).y, corner(wobbled, 0, 1).y); // each by itself
    EXPECT_EQ(corner(wobbled, 2, 0), corner(rest, 2, 0));

    const Move paint{.what = Paint, .target = lamp, .color = {1, 0, 0, 1}, .emission = {0, 0, 9}, .roughness = 0.25f};
    const scene::Scene painted = after(paint);
    EXPECT_EQ(painted.materials[lamp].emission, glm::vec3(0, 0, 9));
    EXPECT_EQ(painted.materials[lamp].baseColor, glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(painted.materials[lamp].roughness, 0.25f);
    EXPECT_EQ(painted.materials[wall].baseColor, rest.materials[wall].baseColor);

    const scene::Scene dimmed = after({.what = Light, .slide = {1, 0, 0}, .color = {0.5f, 0, 1, 1}});
    EXPECT_EQ(dimmed.lights[0].position, glm::vec3(1, 1, 0));
    EXPECT_EQ(dimmed.lights[0].intensity, glm::vec3(0.5f, 0, 3));
}

// Everything is where it was in each frame.
TEST(MovingCases, AreHeldByFiles)
{
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "hunt_moving_case_files";
    for (uint64_t index = 0; index < 30; ++index) {
        const Case c = Session(8, index, {.kind = "moving"}).draw(1);
        writeCase(folder / "case", c, "nothing");
        const Case back = readCase(folder / "case.json");
        ASSERT_EQ(back.moves.size(), c.moves.size());
        for (uint32_t frame = 0; frame < c.settings.frames; ++frame) {
            const scene::Scene expected = c.sceneIn(frame), found = back.sceneIn(frame);
            const auto at = [](const scene::Scene& s, const scene::Triangle& t, size_t i) {
                return s.positions[t.vertices[i]] + glm::vec3(s.origin);
            };
            float size = 0;
            for (const glm::vec3& p : expected.positions) size = std::max(size, glm::length(p));
            for (const scene::Triangle& t : expected.triangles) {
                if (at(expected, t, 0) == at(expected, t, 1)) continue; // without area
                const auto same = [&](const scene::Triangle& other) {
                    for (size_t i = 0; i < 3; ++i)
                        if (glm::distance(at(found, other, i), at(expected, t, i)) > 3e-6f * size) return false;
                    const scene::Material &m = found.materials[other.material], &n = expected.materials[t.material];
                    return m.baseColor == n.baseColor && m.roughness == n.roughness && m.metallic == n.metallic &&
                           glm::distance(m.emission, n.emission) <= 1e-6f * glm::length(n.emission);
                };
                EXPECT_TRUE(std::ranges::any_of(found.triangles, same)) << frame << " " << c.describe();
            }
            for (size_t i = 0; i < expected.lights.size(); ++i) {
                const scene::PunctualLight &a = found.lights[i], &b = expected.lights[i];
                EXPECT_LE(glm::distance(a.intensity, b.intensity), 1e-6f * glm::length(b.intensity));
                const bool isEverywhere = b.kind == scene::LightKind::Directional;
                EXPECT_TRUE(isEverywhere ||
                            glm::distance(a.position + glm::vec3(back.scene.origin), b.position) < 3e-6f * size);
                const bool isRound = b.kind == scene::LightKind::Point;
                EXPECT_TRUE(isRound || glm::distance(a.direction, b.direction) < 1e-5f);
            }
        }
    }
    std::filesystem::remove_all(folder);
}

TEST(MovingCases, ShrinkToTheMoveThatFails)
{
    Case c = Session(2, 4, {.kind = "moving"}).draw(3);
    const uint32_t guilty = c.scene.triangles[2].material;
    c.moves.insert(c.moves.begin() + 1, {.what = Move::What::Place, .target = guilty, .slide = {0, 7, 0}});
    const auto fails = [](const Case& smaller) {
        return std::ranges::any_of(smaller.moves, [](const Move& m) { return m.slide == glm::vec3(0, 7, 0); });
    };
    const Case small = shrink(c, fails, [] { return false; });
    ASSERT_EQ(small.moves.size(), 1u);
    EXPECT_EQ(small.moves[0].slide, glm::vec3(0, 7, 0));
    EXPECT_EQ(small.scene.triangles.size(), 1u);
    EXPECT_EQ(small.moves[0].target, small.scene.triangles[0].material);
}

} // namespace
} // namespace hunt
