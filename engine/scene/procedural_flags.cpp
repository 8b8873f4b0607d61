// The built-in scene "flags".
#include "engine/scene/procedural.h"

#include "engine/scene/motion_builder.h"
#include "engine/scene/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

namespace scene
{

namespace
{

constexpr double PI = std::numbers::pi;
constexpr glm::dvec3 UP = {0, 1, 0};

// Meters. The wall is z = WALL, the street in front of it.
constexpr double PERIOD = 4; // seconds
constexpr float WALL = -2.4f, HALF_WIDTH = 8, HEIGHT = 6.4f, STREET = 8;

// What stands still.
void addStreet(Scene& scene)
{
    const uint32_t plaster = addMaterial(scene, diffuse("plaster", {0.66f, 0.62f, 0.56f}));
    const uint32_t stone = addMaterial(scene, diffuse("stone", {0.42f, 0.40f, 0.38f}));
    const uint32_t paving = addMaterial(scene, glossy("paving", {0.20f, 0.19f, 0.18f}, 0.3f));
    addQuad(scene, paving, {-HALF_WIDTH, 0, WALL}, {0, 0, STREET - WALL}, {2 * HALF_WIDTH, 0, 0});
    addQuad(scene, plaster, {-HALF_WIDTH, 0, WALL}, {2 * HALF_WIDTH, 0, 0}, {0, HEIGHT, 0});
    for (int i = 0; i <= 6; ++i) {
        const float x = HALF_WIDTH * (static_cast<float>(i) / 3 - 1);
        addBox(scene, stone, {x - 0.22f, 0, WALL}, {x + 0.22f, HEIGHT, WALL + 0.2f});
    }
    // Lamps behind low walls: in front of the flags, and behind them.
    const glm::vec3 front[] = {{900, 5, 3}, {5, 18, 1200}, {420, 200, 25}},
                    back[] = {{4, 420, 12}, {420, 4, 200}, {4, 60, 800}};
    for (int i = 0; i < 3; ++i) {
        const float x = 3.2f * static_cast<float>(i - 1);
        addSphere(scene, addMaterial(scene, emitter("front lamp", front[i])), {1.4f * x, 0.16f, 2.4f}, 0.13f, 1);
        addSphere(scene, addMaterial(scene, emitter("back lamp", back[i])), {x + 0.8f, 0.25f, -1.3f}, 0.1f, 1);
    }
    addBox(scene, stone, {-5, 0, 2.8f}, {5, 0.45f, 3});
    addBox(scene, stone, {-5, 0, -1.1f}, {5, 0.45f, -0.95f});
}

void addPole(Scene& scene, uint32_t material, glm::vec3 foot, float height)
{
    addBar(scene, material, foot, foot + glm::vec3(0, height, 0), 0.035f, 12);
    addSphere(scene, material, foot + glm::vec3(0, height, 0), 0.07f, 1);
}

// A cloth of 1.8 m x 1.2 m that hangs from the upper half of a pole, and sags away from it.
Scene hanging()
{
    Scene shape;
    addSurface(shape, 0, {28, 14},
               [](float s, float t) { return glm::vec3(1.8f * s, 1.2f * (t - 1) - 0.12f * s * s, 0); });
    return shape;
}

// A strip along +x that narrows to its end.
Scene strip(float length)
{
    Scene shape;
    addSurface(shape, 0, {48, 4},
               [&](float s, float t) { return glm::vec3(length * s, 0.28f * (1 - 0.7f * s) * (2 * t - 1), 0); });
    return shape;
}

// A wave runs along each: the sum of two that stand, a quarter of their length apart.
void addFlags(Scene& scene, MotionBuilder& builder, std::span<const uint32_t> cloths, uint32_t iron)
{
    const uint32_t flag = builder.addMesh(hanging());
    for (const double quarter : {0.0, 0.25})
        builder.addMorphTarget(flag, [&](const glm::dvec3& p) {
            const double wave = p.x / 1.3 + 0.25 * p.y - quarter;
            return glm::dvec3(0, 0, 0.24 * std::pow(p.x / 1.8, 0.8) * std::sin(2 * PI * wave));
        });
    for (int i = 0; i < 4; ++i) {
        const double x = -4.55 + 2.35 * i, z = i % 2 == 0 ? 0.2 : -0.3, top = i % 2 == 0 ? 3.5 : 4.1;
        const double degrees[] = {25, -35, 40, -25};
        addPole(scene, iron, {x, 0, z}, static_cast<float>(top) + 0.1f);
        const uint32_t node =
            builder.addNode({.translation = {x, top, z}, .rotation = glm::angleAxis(glm::radians(degrees[i]), UP)});
        builder.addPart(node, flag, cloths[static_cast<size_t>(i)]);
        const int waves = 2 + i % 2;
        builder.morph(node, static_cast<uint32_t>(8 * waves), [&](double phase) {
            const double angle = 2 * PI * (waves * phase + 0.3 * i);
            return std::vector<double>{std::cos(angle), std::sin(angle)};
        });
    }
}

// A chain of joints, each of which swings a little later than the one before.
void addPennant(Scene& scene, MotionBuilder& builder, uint32_t cloth, uint32_t iron)
{
    constexpr int JOINTS = 9;
    constexpr double LENGTH = 4.0, LINK = LENGTH / JOINTS;
    const glm::vec3 mast(-2.6f, 0, 1.2f);
    addPole(scene, iron, mast, 1.75f);
    std::vector<uint32_t> joints = {builder.addNode({.translation = glm::dvec3(mast) + 1.4 * UP})};
    while (joints.size() < JOINTS) joints.push_back(builder.addNode({.translation = {LINK, 0, 0}}, joints.back()));
    const uint32_t pennant = builder.addPart(joints[0], builder.addMesh(strip(LENGTH)), cloth);
    builder.bind(pennant, joints, [&](const glm::dvec3& p) {
        const double along = std::max(p.x / LINK - 0.5, 0.0); // joints: each wholly moves the middle of its link
        const auto joint = static_cast<uint32_t>(along);
        if (joint + 1 >= JOINTS) return std::vector<Influence>{{JOINTS - 1, 1}};
        return std::vector<Influence>{{joint, 1 - (along - joint)}, {joint + 1, along - joint}};
    });
    for (size_t i = 0; i < JOINTS; ++i)
        builder.rotate(joints[i], 16, [&](double phase) {
            const double swing = 2 * PI * (2 * phase - 0.13 * double(i));
            return glm::angleAxis(0.32 * std::sin(swing), UP) *
                   glm::angleAxis(0.08 * std::sin(2 * PI * phase - double(i)), glm::dvec3(0, 0, 1));
        });
}

} // namespace

Scene makeFlags()
{
    Scene scene;
    scene.name = "flags";
    addStreet(scene);
    MotionBuilder builder(scene, PERIOD);
    const uint32_t iron = addMaterial(scene, glossy("iron", {0.12f, 0.12f, 0.13f}, 0.35f));
    const uint32_t cloths[] = {addMaterial(scene, diffuse("linen", {0.78f, 0.75f, 0.70f})),
                               addMaterial(scene, diffuse("saffron", {0.78f, 0.50f, 0.10f})),
                               addMaterial(scene, diffuse("sky cloth", {0.30f, 0.52f, 0.74f})),
                               addMaterial(scene, diffuse("rose cloth", {0.76f, 0.40f, 0.42f}))};

    addFlags(scene, builder, cloths, iron);
    addPennant(scene, builder, cloths[0], iron);
    builder.finish();
    scene.cameras.push_back(lookAt("street", {0, 1.8, 6.4}, {0, 2.1, 0}, 46.0));
    return scene;
}

} // namespace scene
