// Which meshes of a file are stored once, and that they stand where their copies would.

#include "engine/scene/gltf_instances.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/scene/motion.h"
#include "tests/support/stored_meshes.h"
#include "tests/support/tiny_gltf.h"

namespace
{

using scene::Instancing;

// The triangle in three places, one of them turned, one mirrored.
class StoredOnce : public testing::Test
{
  protected:
    StoredOnce()
    {
        file.json["nodes"][0]["translation"] = {100, 0, 0};
        file.json["nodes"].push_back({{"mesh", 0}, {"rotation", {0, 0.6, 0, 0.8}}, {"scale", {2, 1, 3}}});
        file.json["nodes"].push_back({{"mesh", 0}, {"translation", {0, -5, 0}}, {"scale", {-1, 2, 1}}});
        file.json["scenes"][0]["nodes"] = {0, 1, 2};
    }
    scene::Scene load(Instancing instancing) const { return file.load({.instancing = instancing}); }
    void expectTheSameWorld(const scene::Scene& stored) const
    {
        const scene::Scene copies = load(Instancing::Off), flat = support::expanded(stored);
        EXPECT_TRUE(copies.instances.empty());
        ASSERT_EQ(flat.triangles.size(), copies.triangles.size());
        const auto corners = [](const scene::Scene& scene) {
            std::vector<std::array<double, 6>> list;
            for (const scene::Triangle& triangle : scene.triangles)
                for (const uint32_t v : triangle.vertices) {
                    const glm::dvec3 p = glm::dvec3(scene.positions[v]) + scene.origin, n = scene.normals[v];
                    list.push_back({p.x, p.y, p.z, n.x, n.y, n.z});
                }
            return list;
        };
        // The order is another one: what is stored once comes last.
        const auto a = corners(flat), b = corners(copies);
        for (const auto& corner : a) {
            double nearest = INFINITY;
            for (const auto& other : b) {
                double difference = 0;
                for (size_t i = 0; i < 6; ++i) difference = std::max(difference, std::abs(corner[i] - other[i]));
                nearest = std::min(nearest, difference);
            }
            EXPECT_LT(nearest, 1e-5);
        }
    }

    TinyGltf file;
};

TEST_F(StoredOnce, AreMeshesInSeveralPlacesWhereAsked)
{
    const scene::Scene scene = load(Instancing::On);
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.instances.size(), 3u);
    EXPECT_TRUE(scene.triangles.empty());
    expectTheSameWorld(scene);
    EXPECT_TRUE(load(Instancing::Auto).instances.empty()) << "copies are few";
}

TEST_F(StoredOnce, AreMeshesOfWhichCopiesWouldBeMany)
{
    // 2^15 places of a mesh of 64 triangles.
    std::vector<float> translations;
    for (int i = 0; i < 32768; ++i) {
        const int row = i / 256;
        translations.insert(translations.end(), {float(i % 256) * 2, 0, float(row)});
    }
    std::vector<uint32_t> indices;
    for (int i = 0; i < 64; ++i) indices.insert(indices.end(), {0, 1, 2});
    const int places = file.accessor(translations, "VEC3");
    file.primitive()["indices"] = file.accessor(indices, "SCALAR");
    file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
    const scene::Scene scene = load(Instancing::Auto);
    EXPECT_EQ(scene.instances.size(), 32768u + 2);
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].triangles.size(), 64u);
}

TEST_F(StoredOnce, EmitNothing)
{
    file.material()["emissiveFactor"] = {1, 1, 1};
    EXPECT_TRUE(load(Instancing::On).instances.empty());
}

TEST_F(StoredOnce, NeverBeginToEmit)
{
    file.material()["emissiveFactor"] = {0, 0, 0};
    file.animatePointer("/materials/0/emissiveFactor", {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3");
    EXPECT_TRUE(load(Instancing::On).instances.empty());
}

TEST_F(StoredOnce, KeepTheirShape)
{
    file.primitive()["targets"] = {{{"POSITION", file.accessor<float>({0, 0, 2, 0, 0, 0, 0, 0, 0}, "VEC3")}}};
    EXPECT_TRUE(load(Instancing::On).instances.empty());
}

// A place that is sheared, and one without depth, have copies.
TEST_F(StoredOnce, AreCopiedWhereTheirTransformDoesNotSuit)
{
    file.json["nodes"][1]["scale"] = {2, 1, 0};
    file.json["nodes"].push_back({{"children", {0}}, {"scale", {50, 1, 1}}});
    file.json["nodes"][0]["rotation"] = {0, 0, 0.6, 0.8};
    file.json["scenes"][0]["nodes"] = {1, 2, 3};
    file.json["nodes"].push_back({{"mesh", 0}});
    file.json["scenes"][0]["nodes"].push_back(4);
    const scene::Scene scene = load(Instancing::On);
    EXPECT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(scene.triangles.size(), 2u);
    expectTheSameWorld(scene);
}

// One turns about the middle and is hidden at the end; what turns and then stretches would be sheared, and has a copy.
TEST_F(StoredOnce, MoveRigidly)
{
    file.animate({{"node", 0}, {"path", "rotation"}}, {0, 1, 2}, {0, 0, 0, 1, 0, 0.6f, 0, 0.8f, 0, 1, 0, 0}, "VEC4");
    file.animate({{"node", 1}, {"path", "scale"}}, {0, 1}, {2, 1, 3, 1, 1, 1}, "VEC3");
    file.animatePointer("/nodes/0/extensions/KHR_node_visibility/visible", {0, 2}, {1, 0}, "SCALAR", "STEP");
    file.json["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = true;
    scene::Scene stored = load(Instancing::On), copies = load(Instancing::Off);
    ASSERT_TRUE(stored.motion);
    EXPECT_EQ(stored.motion->instances.size(), 1u);
    EXPECT_EQ(stored.motion->parts.size(), 1u);
    EXPECT_EQ(stored.instances.size(), 2u);
    const std::vector<uint32_t> all = {0};
    for (const double seconds : {0.0, 0.4, 1.0, 1.7}) {
        scene::pose(stored, all, seconds);
        scene::pose(copies, all, seconds);
        const scene::Scene flat = support::expanded(stored);
        ASSERT_EQ(flat.triangles.size(), 3u);
        double farthest = 0; // of each corner from the nearest of the copies'
        for (const scene::Triangle& triangle : flat.triangles)
            for (const uint32_t v : triangle.vertices) {
                double nearest = INFINITY;
                for (const glm::vec3& p : copies.positions)
                    nearest = std::min(nearest, glm::distance(glm::dvec3(flat.positions[v]) + flat.origin,
                                                              glm::dvec3(p) + copies.origin));
                farthest = std::max(farthest, nearest);
            }
        EXPECT_LT(farthest, 1e-4) << seconds;
    }
    scene::pose(stored, all, 2);
    EXPECT_EQ(support::expanded(stored).triangles.size(), 2u);
    scene::pose(stored, {}, 0);
    EXPECT_EQ(support::expanded(stored).triangles.size(), 3u);
}

} // namespace
