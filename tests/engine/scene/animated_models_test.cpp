// Khronos' animated sample models, at several times, against positions that tests/support/posed_gltf.cpp computes in
// float64 from the specification alone.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/scene/gltf_loader.h"
#include "engine/scene/motion.h"
#include "tests/support/posed_gltf.h"
#include "tests/support/shared_files.h"

namespace scene
{
namespace
{

class AnimatedModels : public testing::Test
{
  protected:
    void SetUp() override { SKIP_WITHOUT_SHARED("scenes/conformance"); }
};

std::filesystem::path model(const std::string& name)
{
    return sharedPath("scenes/conformance/" + name);
}

const std::vector<std::string> MODELS = {"AnimatedCube/AnimatedCube.gltf",
                                         "AnimatedMorphCube/AnimatedMorphCube.gltf",
                                         "AnimatedMorphCube/Quantized/AnimatedMorphCube.gltf",
                                         "AnimatedTriangle/AnimatedTriangle.gltf",
                                         "BoxAnimated/BoxAnimated.gltf",
                                         "CesiumMan/CesiumMan.gltf",
                                         "Fox/Fox.gltf",
                                         "InterpolationTest/InterpolationTest.gltf",
                                         "MorphStressTest/Binary/MorphStressTest.glb",
                                         "RecursiveSkeletons/Binary/RecursiveSkeletons.glb",
                                         "RiggedFigure/RiggedFigure.gltf",
                                         "RiggedSimple/RiggedSimple.gltf",
                                         "SimpleMorph/SimpleMorph.gltf",
                                         "SimpleSkin/SimpleSkin.gltf"};

double sizeOf(const std::vector<std::array<glm::dvec3, 3>>& triangles)
{
    double size = 0;
    for (const auto& corners : triangles)
        for (const glm::dvec3& corner : corners) size = std::max(size, glm::distance(corner, triangles[0][0]));
    return size;
}

// How far apart they are at most. Triangles without area are one point in the scene where they move, and are left out
// where they do not; the scene has lost nothing else.
double worstDistance(const Scene& scene, const std::vector<std::array<glm::dvec3, 3>>& expected)
{
    const double rounding = 2e-6 * sizeOf(expected); // of a position
    double worst = 0;
    size_t next = 0;
    for (const auto& corners : expected) {
        const glm::dvec3 a = corners[1] - corners[0], b = corners[2] - corners[0];
        const double area = glm::length(glm::cross(a, b));
        if (next == scene.triangles.size() && area < 1e-15) continue;
        EXPECT_LT(next, scene.triangles.size());
        if (next >= scene.triangles.size()) return 1e30;
        const auto& vertices = scene.triangles[next++].vertices;
        if (vertices[0] == vertices[1]) {
            EXPECT_LE(area, rounding * std::max(glm::length(a), glm::length(b))) << "triangle " << next - 1;
            continue;
        }
        for (size_t i = 0; i < 3; ++i)
            worst = std::max(worst, glm::distance(glm::dvec3(scene.positions[vertices[i]]) + scene.origin, corners[i]));
    }
    EXPECT_EQ(next, scene.triangles.size());
    return worst;
}

} // namespace

TEST_F(AnimatedModels, AreWhereTheSpecificationHasThem)
{
    for (const std::string& name : MODELS) {
        SCOPED_TRACE(name);
        const PosedGltf expected(model(name));
        Scene scene = loadGltf(model(name));
        ASSERT_TRUE(scene.motion);
        ASSERT_EQ(scene.motion->animations.size(), expected.animationCount());
        double moved = 0;
        for (uint32_t animation = 0; animation < expected.animationCount(); ++animation) {
            const double end = expected.seconds(animation);
            EXPECT_NEAR(scene.motion->animations[animation].seconds, end, 1e-6);
            const auto rest = expected.triangles({}, 0);
            for (const double time : {0.0, 0.31 * end, 0.77 * end, 2 * end}) {
                SCOPED_TRACE(fmt::format("animation {} at {} s", animation, time));
                pose(scene, std::vector{animation}, time);
                const auto triangles = expected.triangles({animation}, time);
                // float32 relative to the middle; keys in float32
                EXPECT_LT(worstDistance(scene, triangles), 2e-6 * sizeOf(rest));
                for (size_t t = 0; t < rest.size(); ++t)
                    for (size_t i = 0; i < 3; ++i) moved = std::max(moved, glm::distance(rest[t][i], triangles[t][i]));
                for (const glm::vec3& normal : scene.normals) ASSERT_NEAR(glm::length(normal), 1, 1e-5);
            }
        }
        EXPECT_GT(moved, 0) << "nothing moved: the test tests nothing";
        pose(scene, {}, 0);
        EXPECT_LT(worstDistance(scene, expected.triangles({}, 0)), 2e-6 * sizeOf(expected.triangles({}, 0)));
    }
}

TEST_F(AnimatedModels, AllAnimationsTogether)
{
    for (const std::string name : {"Fox/Fox.gltf", "InterpolationTest/InterpolationTest.gltf"}) {
        const PosedGltf expected(model(name));
        Scene scene = loadGltf(model(name));
        std::vector<size_t> all;
        for (size_t i = 0; i < expected.animationCount(); ++i) all.push_back(i);
        for (const double time : {0.2, 0.9, 1.6}) {
            pose(scene, chooseAnimations(scene, "all"), time);
            const auto triangles = expected.triangles(all, time);
            EXPECT_LT(worstDistance(scene, triangles), 4e-6 * sizeOf(triangles)) << name << ' ' << time;
        }
        EXPECT_EQ(contested(*scene.motion, chooseAnimations(scene, "all")), name == "Fox/Fox.gltf");
    }
}

// A pose depends on the time alone: not on the poses before it, nor on which copy of the scene it is.
TEST_F(AnimatedModels, APoseIsTheSameBitsHoweverOneGetsThere)
{
    for (const std::string name : {"CesiumMan/CesiumMan.gltf", "MorphStressTest/Binary/MorphStressTest.glb",
                                   "InterpolationTest/InterpolationTest.gltf"}) {
        const Scene rest = loadGltf(model(name));
        const std::vector<uint32_t> first = {0};
        Scene direct = rest, wandering = loadGltf(model(name));
        pose(direct, first, 0.7);
        for (const double time : {5.0, 0.1, 1.3, 0.7}) pose(wandering, first, time);
        EXPECT_EQ(direct.positions, wandering.positions);
        EXPECT_EQ(direct.normals, wandering.normals);
        EXPECT_EQ(direct.tangents, wandering.tangents);
        EXPECT_NE(direct.positions, rest.positions);
        pose(wandering, {}, 0);
        EXPECT_EQ(wandering.positions, rest.positions);
        EXPECT_EQ(wandering.normals, rest.normals);
        EXPECT_EQ(wandering.origin, rest.origin);
    }
}

// Of the sample models, those without animations keep nothing for motion.
TEST_F(AnimatedModels, StaticOnesHaveNoMotion)
{
    for (const std::string name : {"Box/Box.gltf", "Duck/Binary/Duck.glb", "NormalTangentTest/NormalTangentTest.gltf",
                                   "SimpleInstancing/SimpleInstancing.gltf"}) {
        Scene scene = loadGltf(model(name));
        EXPECT_EQ(scene.motion, nullptr);
        const Scene before = scene;
        pose(scene, {}, 3);
        EXPECT_EQ(scene.positions, before.positions);
    }
}

} // namespace scene
