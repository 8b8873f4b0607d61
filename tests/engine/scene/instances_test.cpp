#include "engine/scene/instances.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/scene/motion.h"
#include "engine/scene/motion_builder.h"
#include "engine/scene/scene_tables.h"
#include "engine/scene/shapes.h"
#include "shaders/shared/bvh.h"
#include "tests/support/stored_meshes.h"

namespace
{

using scene::Scene;

constexpr uint64_t ROOM = uint64_t{1} << 30;
const glm::dmat4 I(1);

// A floor and a box in these places.
Scene boxes(const std::vector<glm::dmat4>& places)
{
    Scene scene;
    scene::addQuad(scene, scene::addMaterial(scene, scene::diffuse("floor", {1, 1, 1})), {-1, 0, -1}, {0, 0, 1},
                   {1, 0, 0});
    const uint32_t box = scene::addMaterial(scene, scene::diffuse("box", {1, 1, 1}));
    scene::addBox(scene, box, {-1, -1, -1}, {1, 1, 1});
    scene.lights.push_back({.position = {0, 3, 0}});
    return support::storedOnce(std::move(scene), box, places);
}

TEST(Instances, SuitTurnsScalesAndMirrors)
{
    const glm::dmat4 turned = glm::rotate(glm::translate(I, {1e6, -3, 2}), 1.0, glm::dvec3(1, 2, 3));
    EXPECT_TRUE(scene::suitsInstance(I));
    EXPECT_TRUE(scene::suitsInstance(glm::scale(turned, {1e-3, 5, 1e4})));
    EXPECT_TRUE(scene::suitsInstance(glm::scale(turned, {-1, 1, 1})));
}

TEST(Instances, SuitNeitherShearsNorWhatHasNoInverse)
{
    const glm::dmat4 turned = glm::rotate(I, 1.0, glm::dvec3(1, 2, 3));
    EXPECT_FALSE(scene::suitsInstance(glm::scale(I, {1, 1, 0})));
    EXPECT_FALSE(scene::suitsInstance(glm::scale(I, {100, 1, 1}) * turned)); // a turn, then a stretch
    glm::dmat4 broken = I;
    broken[3][1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(scene::suitsInstance(broken));
    broken = I;
    broken[1][1] = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(scene::suitsInstance(broken));
}

TEST(Instances, AreInTheBoxThatIsSaidOfThem)
{
    const scene::Box box{{-1, -2, 0}, {1, 2, 4}};
    const auto [lower, upper] =
        scene::extentOf(box, glm::rotate(glm::translate(I, {10, 0, 0}), std::numbers::pi / 2, glm::dvec3(0, 0, 1)));
    EXPECT_LT(glm::distance(lower, glm::dvec3(8, -1, 0)), 1e-12);
    EXPECT_LT(glm::distance(upper, glm::dvec3(12, 1, 4)), 1e-12);
    Scene scene = boxes({glm::translate(I, {3, 0, 0}), glm::translate(I, {0, 90, 0})});
    EXPECT_NEAR(scene::squaredRadiusOfInstances(scene, scene::boxesOf(scene.meshes)), 91 * 91 + 2, 1e-9);
    scene.instances[1].visible = false;
    EXPECT_NEAR(scene::squaredRadiusOfInstances(scene, scene::boxesOf(scene.meshes)), 16 + 2, 1e-9);
}

// The mesh is there once however many places it has; a place takes eight rows, and its share of a tree.
TEST(Instances, TakeNoCopies)
{
    std::vector<glm::dmat4> places;
    for (int i = 0; i < 1000; ++i) {
        const int row = i / 32;
        places.push_back(glm::translate(I, {3.0 * (i % 32), 0, 3.0 * row}));
    }
    const scene::SceneTables one = scene::makeSceneTables(boxes({I}), ROOM);
    const scene::SceneTables many = scene::makeSceneTables(boxes(places), ROOM);
    EXPECT_EQ(one.meshes.nodes, many.meshes.nodes);
    EXPECT_EQ(one.meshes.triangles, many.meshes.triangles);
    EXPECT_EQ(one.meshes.attributes, many.meshes.attributes);
    EXPECT_EQ(one.attributes.size(), many.attributes.size());
    EXPECT_EQ(many.places.rows.size(), 1000 * size_t{shared::INSTANCE_ROWS});
    EXPECT_EQ(many.places.records.size(), 1000 * size_t{shared::BVH_RECORD_STRIDE});
    EXPECT_LE(many.places.nodes.size(), scene::roomForNodesOver(1000));
    EXPECT_EQ(many.sceneData.size() - one.sceneData.size(), 999 * size_t{shared::INSTANCE_ROWS});
}

TEST(Instances, NumberTheirTrianglesOneAfterTheOther)
{
    const scene::SceneTables tables = scene::makeSceneTables(boxes({I, glm::translate(I, {4, 0, 0})}), ROOM);
    EXPECT_EQ(tables.uniform.flatTriangles, 2u);
    EXPECT_EQ(tables.uniform.triangleBits, 4u); // of 12 triangles
    std::vector<uint32_t> firsts;
    for (size_t i = 3; i < tables.places.records.size(); i += shared::BVH_RECORD_STRIDE)
        firsts.push_back(tables.places.records[i].y);
    std::ranges::sort(firsts);
    EXPECT_EQ(firsts, (std::vector<uint32_t>{2, 2 + 16}));
}

TEST(Instances, OfWhichThereAreTooManyToNumberAreRefused)
{
    Scene scene = boxes(std::vector<glm::dmat4>(2048, I));
    scene.meshes[0].triangles.resize(size_t{1} << 20, scene.meshes[0].triangles[0]);
    try {
        scene::makeSceneTables(scene, ROOM);
        FAIL() << "taken";
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()), "The scene has 2048 instances of meshes of up to 1048576 triangles, too "
                                             "many to number: use fewer, or simplify the meshes.");
    }
}

TEST(Instances, ThatDoNotFitTheDeviceAreRefused)
{
    EXPECT_THROW(scene::makeSceneTables(boxes(std::vector<glm::dmat4>(2000, I)), uint64_t(64) * 1024), Error);
}

TEST(Instances, HaveTheirMaterialsCompiledIn)
{
    Scene scene = boxes({I});
    EXPECT_FALSE(scene::makeSceneTables(scene, ROOM).features.HAS_ALPHA);
    scene.materials[1].alpha = scene::Alpha::Mask;
    scene.meshes[0].colors.assign(scene.meshes[0].positions.size(), glm::vec4(0.5f));
    const scene::SceneTables tables = scene::makeSceneTables(scene, ROOM);
    EXPECT_TRUE(tables.features.HAS_ALPHA);
    EXPECT_TRUE(tables.features.HAS_VERTEX_COLORS);
    EXPECT_TRUE(tables.features.HAS_INSTANCES);
    EXPECT_FALSE(scene::makeSceneTables(support::expanded(scene), ROOM).features.HAS_INSTANCES);
}

// A box that turns, beside one that rests: its place alone differs from pose to pose. Where none moves, none is made
// anew.
TEST(Instances, MoveByTheirPlacesAlone)
{
    for (const bool moves : {true, false}) {
        Scene scene = boxes({glm::translate(I, {5, 0, 0})});
        scene::MotionBuilder builder(scene, 8);
        Scene shape;
        scene::addBox(shape, scene::addMaterial(shape, {}), {-1, -1, -1}, {1, 1, 1});
        const uint32_t node = builder.addNode({.translation = {0, 2, 0}});
        if (moves)
            builder.addInstance(node, builder.storeMesh(shape, 1));
        else
            builder.addPart(node, builder.addMesh(shape), 1);
        builder.turn(node, {0, 1, 0}, 1);
        builder.finish();
        scene::MovingTables tables(scene, ROOM);
        const scene::SceneTables rest = tables.last();
        scene::pose(scene, std::vector<uint32_t>{0}, 1);
        const scene::SceneTables& posed = tables.at(scene);
        EXPECT_EQ(posed.places.records != rest.places.records, moves);
        EXPECT_EQ(posed.places.rows != rest.places.rows, moves);
        EXPECT_EQ(posed.attributes != rest.attributes, !moves);
        EXPECT_EQ(posed.places.rows.size(), (moves ? 2 : 1) * size_t{shared::INSTANCE_ROWS});
        if (!moves) continue;
        const glm::dvec3 corner(scene.instances[1].worldFromMesh * glm::dvec4(1, 0, 0, 1));
        EXPECT_LT(glm::distance(corner, glm::dvec3(std::sqrt(0.5), 2, -std::sqrt(0.5))), 1e-6); // an eighth of a turn
    }
}

} // namespace
