#include "engine/scene/shapes.h"

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <tuple>

#include <glm/gtc/matrix_transform.hpp>

namespace scene
{
namespace
{

using Point = std::tuple<float, float, float>;

// Closed and consistently oriented: every directed edge, by position, has exactly one partner the other way.
void expectWatertight(const Scene& scene)
{
    std::map<std::pair<Point, Point>, int> edges;
    const auto point = [&](uint32_t vertex) {
        const glm::vec3 p = scene.positions[vertex] + glm::vec3(0); // -0 becomes 0
        return Point(p.x, p.y, p.z);
    };
    for (const Triangle& triangle : scene.triangles)
        for (size_t i = 0; i < 3; ++i) ++edges[{point(triangle.vertices[i]), point(triangle.vertices[(i + 1) % 3])}];
    for (const auto& [edge, count] : edges) {
        EXPECT_EQ(count, 1);
        const auto partner = edges.find({edge.second, edge.first});
        EXPECT_TRUE(partner != edges.end() && partner->second == 1);
    }
}

// By the divergence theorem; positive when fronts face outward.
double volume(const Scene& scene)
{
    double sum = 0;
    for (const Triangle& triangle : scene.triangles) {
        const glm::dvec3 a = scene.positions[triangle.vertices[0]], b = scene.positions[triangle.vertices[1]],
                         c = scene.positions[triangle.vertices[2]];
        sum += glm::dot(a, glm::cross(b, c)) / 6;
    }
    return sum;
}

void expectNormalsFollowTheFaces(const Scene& scene, double minimumCosine)
{
    ASSERT_EQ(scene.normals.size(), scene.positions.size());
    for (const glm::vec3& normal : scene.normals) EXPECT_NEAR(glm::length(normal), 1, 1e-6);
    for (const Triangle& triangle : scene.triangles) {
        const auto& [a, b, c] = triangle.vertices;
        const glm::vec3 face = glm::normalize(
            glm::cross(scene.positions[b] - scene.positions[a], scene.positions[c] - scene.positions[a]));
        for (const uint32_t vertex : triangle.vertices) EXPECT_GT(glm::dot(scene.normals[vertex], face), minimumCosine);
    }
}

TEST(Shapes, BoxIsClosedAndHasItsVolume)
{
    Scene scene;
    glm::mat4 transform =
        glm::rotate(glm::translate(glm::mat4(1), {0.1f, 2, -3}), 0.7f, glm::normalize(glm::vec3(1, 2, 3)));
    addBox(scene, 0, glm::scale(transform, {0.5f, 1, 2}));
    EXPECT_EQ(scene.triangles.size(), 12u);
    expectWatertight(scene);
    expectNormalsFollowTheFaces(scene, 0.9999);
    EXPECT_NEAR(volume(scene), 8.0, 1e-4);
}

TEST(Shapes, SphereIsClosedAndNearlyHasItsVolume)
{
    for (const Normals normals : {Normals::Smooth, Normals::Flat})
        for (const Facing facing : {Facing::Outward, Facing::Inward}) {
            Scene scene;
            addSphere(scene, 0, {0.3f, -0.2f, 0.1f}, 2, 3, normals, facing);
            EXPECT_EQ(scene.triangles.size(), 1280u);
            expectWatertight(scene);
            expectNormalsFollowTheFaces(scene, 0.99);
            const double truth = 4.0 / 3 * std::numbers::pi * 8;
            EXPECT_NEAR(volume(scene) * (facing == Facing::Inward ? -1 : 1), truth, 0.01 * truth);
        }
}

TEST(Shapes, LatheThatStartsAndEndsOnTheAxisIsClosed)
{
    Scene scene;
    const glm::vec2 profile[] = {{0, 0}, {1, 0}, {1, 2}, {0.5f, 2.5f}, {0, 2.5f}};
    addLathe(scene, 0, {1, 2, 3}, profile, 200);
    expectWatertight(scene);
    expectNormalsFollowTheFaces(scene, 0.99);
    const double truth = std::numbers::pi * (2 + 0.5 / 3 * (1 + 0.5 + 0.25)); // a cylinder and a frustum
    EXPECT_NEAR(volume(scene), truth, 1e-3 * truth);
}

TEST(Shapes, QuadAndBarFaceWhereTheySay)
{
    Scene scene;
    addQuad(scene, 0, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    expectNormalsFollowTheFaces(scene, 0.9999);
    EXPECT_EQ(scene.normals[0], glm::vec3(0, 0, 1));
    scene = {};
    addBar(scene, 0, {1, 1, 1}, {1, 3, 2}, 0.1f, 12);
    expectNormalsFollowTheFaces(scene, 0.9);
    for (size_t i = 0; i < scene.positions.size(); ++i) { // outward
        const glm::vec3 axis = glm::normalize(glm::vec3(0, 2, 1)), fromAxis = scene.positions[i] - glm::vec3(1, 1, 1);
        EXPECT_NEAR(glm::length(fromAxis - glm::dot(fromAxis, axis) * axis), 0.1, 1e-6);
        EXPECT_GT(glm::dot(fromAxis, scene.normals[i]), 0.09f);
    }
}

TEST(Shapes, CameraIsAnOrthonormalRightHandedFrame)
{
    const Camera camera = lookAt("test", {1, 2, 3}, {4, -1, 2}, 50);
    EXPECT_NEAR(glm::length(camera.forward), 1, 1e-15);
    EXPECT_NEAR(glm::length(camera.right), 1, 1e-15);
    EXPECT_NEAR(glm::dot(camera.right, camera.forward), 0, 1e-15);
    EXPECT_NEAR(camera.right.y, 0, 1e-15);
    EXPECT_GT(camera.up.y, 0);
    EXPECT_NEAR(glm::length(glm::cross(camera.right, camera.up) + camera.forward), 0, 1e-15);
}

} // namespace
} // namespace scene
