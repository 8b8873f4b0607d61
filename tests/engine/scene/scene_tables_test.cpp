// Tables of scenes that move against those of the same scene at rest.
// Covers engine/scene/material_tables.cpp, engine/scene/attribute_tables.cpp.

#include "engine/scene/scene_tables.h"

#include <algorithm>
#include <array>
#include <bit>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/scene/motion.h"
#include "engine/scene/shapes.h"
#include "shaders/shared/bvh.h"
#include "tests/support/moving_worlds.h"
#include "tests/support/test_scenes.h"

namespace scene
{
namespace
{

using Rows = std::vector<glm::uvec4>;

constexpr uint64_t ANY_SIZE = uint64_t{1} << 40;

Scene moving(Scene scene, std::initializer_list<uint32_t> painted = {})
{
    const auto motion = std::make_shared<Motion>();
    for (const uint32_t material : painted) motion->paints.push_back({.material = material});
    scene.motion = motion;
    return scene;
}

// The triangles of a tree's records.
std::multiset<uint32_t> recorded(const Bvh& bvh)
{
    std::multiset<uint32_t> found;
    for (size_t record = 0; record < bvh.stats.triangleRecords; ++record) {
        const glm::uvec4* words = &bvh.triangles[record * shared::BVH_RECORD_STRIDE];
        found.insert(words[0].w & ~shared::BVH_ALPHA_FLAG);
        if (glm::uvec3(words[3]) != glm::uvec3(words[1])) found.insert(words[1].w);
    }
    return found;
}

std::string missing(const SceneFeatures& has, const SceneFeatures& needed)
{
    std::string names;
#define COMPARE(ID, TYPE, NAME, DEFAULT, WHAT)                                                                         \
    if (needed.NAME && !has.NAME) names += #NAME " ";
    SCENE_FEATURES(COMPARE)
#undef COMPARE
    return names + (needed.blend && !has.blend ? "blend" : "");
}

void expectFits(const SceneTables& tables, const TableSizes& most)
{
    EXPECT_LE(tables.bvh.nodes.size(), most.nodes);
    EXPECT_LE(tables.bvh.triangles.size(), most.triangles);
    EXPECT_LE(tables.attributes.size(), most.attributes);
    EXPECT_LE(tables.sceneData.size(), most.sceneData);
    EXPECT_LE(tables.bvh.stats.depth, most.depth);
}

// What a material without lobes of a width says of their width is not asked. (Roughness 0 beside rough materials was a
// microfacet distribution of width 0, and its product with the missing lobe's 0 no number.)
TEST(SceneTables, RoughnessOfMissingLobesIsNotKept)
{
    Scene scene;
    addQuad(scene, addMaterial(scene, diffuse("dull", {0.6f, 0.5f, 0.4f})), {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
    addQuad(scene, addMaterial(scene, {.metallic = 0, .roughness = 0.5f}), {-1, 1, 1}, {2, 0, 0}, {0, 0, -2});
    scene.images.push_back({.width = 1, .height = 1, .rgba = {0, 0, 0, 255}}); // green: times 0
    Material& material = scene.materials.at(0);
    material.specular = material.metallic = material.transmission = 0;
    material.roughness = 1;
    const SceneTables smooth = makeSceneTables(scene, ANY_SIZE);
    material.roughness = 0;
    material.metallicRoughnessTexture.image = 0;
    const SceneTables rough = makeSceneTables(scene, ANY_SIZE);
    EXPECT_EQ(rough.sceneData, smooth.sceneData);
    EXPECT_EQ(missing(rough.features, smooth.features) + missing(smooth.features, rough.features), "");
    EXPECT_TRUE(rough.features.HAS_ROUGH && !rough.features.HAS_DIRAC); // of the other material

    material.metallic = 0.5f; // now it has one
    EXPECT_TRUE(makeSceneTables(scene, ANY_SIZE).features.HAS_DIRAC);
}

// What pose() is asked for before anything has moved is the still scene, also after other poses.
TEST(MovingTables, AtRestAreThoseOfTheStillScene)
{
    for (const support::TestScene& test : support::testScenes()) {
        SCOPED_TRACE(test.name);
        const Scene scene = moving(test.make());
        const SceneTables still = makeSceneTables(scene, ANY_SIZE);
        MovingTables tables(scene, ANY_SIZE);
        EXPECT_EQ(tables.last().texels, still.texels);
        EXPECT_EQ(tables.last().environment, still.environment);
        EXPECT_EQ(tables.last().lengthScale, still.lengthScale);
        EXPECT_EQ(tables.last().radianceScale, still.radianceScale);
        EXPECT_EQ(missing(still.features, tables.last().features), "");
        EXPECT_EQ(missing(tables.last().features, still.features), "");
        Scene away = scene;
        for (glm::vec3& p : away.positions) p = 3.0f * glm::vec3(p.y, p.z, p.x);
        for (const bool after : {false, true}) {
            if (after) expectFits(tables.at(away), tables.most());
            const SceneTables rest = tables.at(scene);
            expectFits(rest, tables.most());
            EXPECT_EQ(rest.attributes, still.attributes);
            EXPECT_EQ(rest.sceneData, still.sceneData);
            using Words = std::array<uint32_t, sizeof(still.uniform) / sizeof(uint32_t)>;
            EXPECT_EQ(std::bit_cast<Words>(rest.uniform), std::bit_cast<Words>(still.uniform));
            EXPECT_EQ(rest.lights.emissiveTriangles, still.lights.emissiveTriangles);
            EXPECT_EQ(rest.lights.environments, still.lights.environments);
            const std::multiset<uint32_t> in = recorded(still.bvh), once(recorded(rest.bvh));
            EXPECT_EQ(std::set(in.begin(), in.end()), std::set(once.begin(), once.end()));
            EXPECT_EQ(once.size(), std::set(once.begin(), once.end()).size());
        }
    }
}

TEST(MovingTables, OfEachPoseKeepScalesAndFitAndHaveItsLights)
{
    for (const support::MovingWorld& world : support::movingWorlds()) {
        MovingTables tables(world.at(0), ANY_SIZE);
        const SceneTables rest = tables.last();
        for (const uint32_t frame : {1u, 2u, 3u, 4u, 0u, 9u}) {
            SCOPED_TRACE(std::string(world.name) + " " + std::to_string(frame));
            const Scene scene = world.at(frame);
            const SceneTables pose = tables.at(scene), still = makeSceneTables(scene, ANY_SIZE);
            expectFits(pose, tables.most());
            EXPECT_EQ(pose.lengthScale, rest.lengthScale);
            EXPECT_EQ(pose.radianceScale, rest.radianceScale);
            EXPECT_EQ(missing(pose.features, still.features), "");
            EXPECT_EQ(pose.uniform.environmentOffset, rest.uniform.environmentOffset);
            EXPECT_EQ(pose.uniform.environmentAliasOffset, rest.uniform.environmentAliasOffset);
            const auto lights = [](const SceneTables& t) { // kind and index, of those that shine
                std::vector<uint32_t> list;
                for (uint32_t i = 0; i < t.uniform.lightCount; ++i) {
                    const glm::uvec4 row = t.sceneData[t.uniform.lightOffset - t.environment.size() + i];
                    if (std::bit_cast<float>(row.z) > 0) list.push_back(row.w);
                }
                return list;
            };
            EXPECT_EQ(lights(pose), lights(still));
        }
    }
}

// Materials as animations may make them, from ones that need little.
TEST(MovingTables, ProvideForWhatAnyPoseMayNeed)
{
    for (const Material& rest : {Material{.metallic = 0, .roughness = 0.5f, .specular = 0},
                                 Material{.metallic = 0, .roughness = 0, .specular = 0},
                                 Material{.metallic = 1, .roughness = 0}, Material{.metallic = 1, .roughness = 1},
                                 Material{.metallic = 0, .roughness = 0.3f, .transmission = 1, .thin = false},
                                 Material{.metallic = 0, .roughness = 0.3f, .specular = 0, .unlit = true}}) {
        Scene scene;
        addSphere(scene, addMaterial(scene, rest), {0, 0, 0}, 1, 1);
        scene.images.push_back({.width = 1, .height = 1, .rgba = {255, 255, 255, 255}});
        scene.materials[0].emissiveTexture.image = 0;
        scene.uv0.resize(scene.positions.size());
        scene = moving(scene, {0});
        MovingTables tables(scene, ANY_SIZE);
        for (const float metallic : {0.0f, 0.5f, 1.0f})
            for (const float roughness : {0.0f, 0.5f, 1.0f})
                for (const float emission : {0.0f, 2.0f}) {
                    Scene pose = scene;
                    pose.materials[0].metallic = metallic;
                    pose.materials[0].roughness = roughness;
                    pose.materials[0].emission = glm::vec3(emission);
                    const SceneTables still = makeSceneTables(pose, ANY_SIZE);
                    EXPECT_EQ(missing(tables.last().features, still.features), "")
                        << metallic << ' ' << roughness << ' ' << emission;
                    expectFits(tables.at(pose), tables.most());
                    EXPECT_EQ(tables.at(pose).lights.emissiveTriangles, still.lights.emissiveTriangles);
                }
    }
}

// A lamp that is hidden at rest, lights without intensity: there is room for all of them, and shaders know them.
TEST(MovingTables, ProvideForWhatIsHiddenAtRest)
{
    Scene shown;
    const uint32_t floor = addMaterial(shown, diffuse("floor", {0.5f, 0.5f, 0.5f}));
    addQuad(shown, floor, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
    addSphere(shown, addMaterial(shown, emitter("lamp", {1, 1, 1})), {0, 1, 0}, 0.2f, 1);
    shown.lights.push_back({.kind = LightKind::Point, .intensity = {1, 1, 1}});
    shown.lights.push_back({.kind = LightKind::Directional, .intensity = {1, 1, 1}});
    Scene rest = moving(shown);
    support::hide(rest, 2, rest.triangles.size());
    for (PunctualLight& light : rest.lights) light.intensity = glm::vec3(0);

    MovingTables tables(rest, ANY_SIZE);
    EXPECT_EQ(tables.at(rest).uniform.lightCount, 0u);
    const SceneTables still = makeSceneTables(shown, ANY_SIZE), pose = tables.at(shown);
    EXPECT_EQ(missing(tables.last().features, still.features), "");
    expectFits(pose, tables.most());
    EXPECT_EQ(pose.uniform.lightCount, still.uniform.lightCount);
    EXPECT_EQ(recorded(pose.bvh).size(), shown.triangles.size());
    MovingTables copy = tables;
    EXPECT_EQ(copy.at(rest).sceneData, tables.at(rest).sceneData);
}

// Both poses must fit, but textures and sky are there once.
TEST(MovingTables, FitTheDeviceWithBothPoses)
{
    Scene scene;
    addSphere(scene, addMaterial(scene, diffuse("ball", {0.5f, 0.5f, 0.5f})), {0, 0, 0}, 1, 3);
    scene = moving(scene);
    const TableSizes most = MovingTables(scene, ANY_SIZE).most();
    const uint64_t largest =
        2 * sizeof(glm::uvec4) * std::max({most.nodes, most.triangles, most.attributes, most.sceneData});
    EXPECT_NO_THROW(MovingTables(scene, largest));
    EXPECT_THROW(MovingTables(scene, largest - 2), Error);

    Scene textured = support::ballOf({});
    textured.uv0.resize(textured.positions.size());
    textured.images.push_back({.width = 512, .height = 512, .rgba = std::vector<uint8_t>(size_t{4} * 512 * 512)});
    textured.materials.back().baseColorTexture.image = 0;
    textured = moving(textured);
    const uint64_t texels = makeSceneTables(textured, ANY_SIZE).texels.size() * sizeof(glm::uvec4);
    ASSERT_GE(texels, uint64_t{1} << 20);
    EXPECT_NO_THROW(MovingTables(textured, texels));
    EXPECT_THROW(MovingTables(textured, texels - 1), Error);
}

} // namespace
} // namespace scene
