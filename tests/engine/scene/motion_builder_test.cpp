#include "engine/scene/motion_builder.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace scene
{
namespace
{

constexpr double PI = std::numbers::pi;
constexpr glm::dvec3 X = {1, 0, 0}, Y = {0, 1, 0}, Z = {0, 0, 1};
const std::vector<uint32_t> FIRST = {0};

// One triangle: 0, X, Y.
Scene corner()
{
    Scene shape;
    shape.positions = {{0, 0, 0}, X, Y};
    shape.normals.assign(3, Z);
    shape.triangles = {{{0, 1, 2}}};
    return shape;
}

class MotionBuilderTest : public testing::Test
{
  protected:
    MotionBuilderTest() { scene_.name = "test"; }

    void expectAt(double seconds, size_t vertex, const glm::dvec3& position, double tolerance = 1e-6)
    {
        pose(scene_, FIRST, seconds);
        const glm::dvec3 found = scene_.positions[vertex];
        EXPECT_LT(glm::distance(found, position), tolerance)
            << seconds << " s: " << found.x << ' ' << found.y << ' ' << found.z;
    }

    Scene scene_{.materials = std::vector<Material>(5)};
};

} // namespace

TEST_F(MotionBuilderTest, PartsAreAppendedAndShareAMesh)
{
    scene_ = corner();
    MotionBuilder builder(scene_, 1);
    const uint32_t node = builder.addNode({.translation = 5.0 * Z});
    const uint32_t mesh = builder.addMesh(corner());
    builder.addPart(node, mesh, 3);
    builder.addPart(node, mesh, 4, glm::dmat4(glm::dvec4(Y, 0), glm::dvec4(-X, 0), glm::dvec4(Z, 0), {2, 0, 0, 1}));
    builder.finish();
    EXPECT_EQ(scene_.motion->meshes.size(), 1u);
    ASSERT_EQ(scene_.triangles.size(), 3u);
    EXPECT_EQ(scene_.triangles[1].material, 3u);
    EXPECT_EQ(scene_.triangles[2].material, 4u);
    EXPECT_EQ(scene_.triangles[2].vertices, (std::array<uint32_t, 3>{6, 7, 8}));
    expectAt(0, 1, X);
    expectAt(0, 4, X + 5.0 * Z);
    expectAt(0, 7, 2.0 * X + Y + 5.0 * Z);
    expectAt(0, 8, X + 5.0 * Z);
}

// Evenly, from the pose at rest, the way that the sign says; a child goes along.
TEST_F(MotionBuilderTest, TurnsEvenly)
{
    MotionBuilder builder(scene_, 8);
    const uint32_t parent = builder.addNode({.rotation = glm::angleAxis(PI / 2, Z)});
    builder.turn(parent, Z, -2);
    builder.addPart(builder.addNode({.translation = X}, parent), builder.addMesh(corner()), 0);
    builder.finish();
    expectAt(0, 0, Y);
    for (const double seconds : {0.3, 1.0, 2.9, 7.7, 8.0}) {
        const double angle = PI / 2 - 2 * 2 * PI * seconds / 8;
        expectAt(seconds, 0, {std::cos(angle), std::sin(angle), 0});
    }
}

TEST_F(MotionBuilderTest, FollowsWhatItIsGivenBetweenKeys)
{
    MotionBuilder builder(scene_, 2);
    const auto place = [](double phase) {
        return glm::dvec3(std::cos(2 * PI * phase), 0, 3 * std::sin(2 * PI * phase));
    };
    const auto rock = [](double phase) { return glm::angleAxis(0.4 * std::cos(2 * PI * phase), Z); };
    const uint32_t node = builder.addNode({});
    builder.translate(node, 16, place);
    builder.rotate(node, 16, rock);
    builder.addPart(node, builder.addMesh(corner()), 0);
    builder.finish();
    for (const double seconds : {0.0, 0.125, 0.2, 0.77, 1.31, 1.99, 2.0}) {
        expectAt(seconds, 0, place(seconds / 2), 3e-4);
        expectAt(seconds, 1, place(seconds / 2) + rock(seconds / 2) * X, 5e-4);
    }
    const Scene animated = scene_;
    pose(scene_, FIRST, 0);
    const std::vector<glm::vec3> first = scene_.positions;
    pose(scene_, {}, 1);
    EXPECT_EQ(scene_.positions, first) << "at rest is at 0 s";
}

TEST_F(MotionBuilderTest, MorphTargetsBendNormalsToo)
{
    MotionBuilder builder(scene_, 1);
    const uint32_t mesh = builder.addMesh(corner());
    builder.addMorphTarget(mesh, [](const glm::dvec3& p) { return p.x * Z; });
    const uint32_t node = builder.addNode({});
    builder.morph(node, 8, [](double phase) { return std::vector<double>{std::sin(2 * PI * phase)}; });
    builder.addPart(node, mesh, 0);
    builder.finish();
    expectAt(0, 1, X);
    expectAt(0.25, 1, X + Z);
    expectAt(0.25, 2, Y);
    EXPECT_LT(glm::distance(glm::dvec3(scene_.normals[2]), glm::normalize(Z - X)), 1e-6);
    expectAt(0.75, 1, X - Z);
}

// The second joint, one away along x in a chain, takes the vertex at x = 1 along, and half of that at y = 1.
TEST_F(MotionBuilderTest, JointsTakeBoundPartsAlong)
{
    MotionBuilder builder(scene_, 4);
    const uint32_t root = builder.addNode({.translation = 7.0 * Z});
    const uint32_t joint = builder.addNode({.translation = X}, root);
    const uint32_t part = builder.addPart(root, builder.addMesh(corner()), 0, glm::dmat4(glm::dmat3(2.0)));
    builder.bind(part, {root, joint}, [](const glm::dvec3& p) {
        return std::vector<Influence>{{0, 1 - p.x - p.y / 2}, {1, p.x + p.y / 2}};
    });
    builder.translate(joint, 4, [](double phase) { return X + (1 - std::cos(2 * PI * phase)) * Y; });
    builder.finish();
    expectAt(0, 1, 2.0 * X + 7.0 * Z);
    expectAt(2, 0, 7.0 * Z);
    expectAt(2, 1, 2.0 * X + 2.0 * Y + 7.0 * Z);
    expectAt(2, 2, 3.0 * Y + 7.0 * Z);
}

TEST_F(MotionBuilderTest, LightsGoWithTheirNodes)
{
    MotionBuilder builder(scene_, 4);
    const uint32_t node = builder.addNode({.translation = X});
    builder.turn(node, Y, 1);
    builder.addLight(
        node, {.kind = LightKind::Spot, .intensity = {3, 2, 0.5f}, .innerConeAngle = 0.25f, .outerConeAngle = 0.5f});
    builder.finish();
    pose(scene_, FIRST, 1);
    ASSERT_EQ(scene_.lights.size(), 1u);
    const PunctualLight& light = scene_.lights[0];
    EXPECT_EQ(light.intensity, glm::vec3(3, 2, 0.5f));
    EXPECT_EQ(light.innerConeAngle, 0.25f);
    EXPECT_EQ(light.outerConeAngle, 0.5f);
    EXPECT_LT(glm::distance(glm::dvec3(light.position), X), 1e-6);
    EXPECT_LT(glm::distance(glm::dvec3(light.direction), -X), 1e-6);
}

} // namespace scene
