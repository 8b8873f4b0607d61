// The built-in scene "carousel".
#include "engine/scene/procedural.h"

#include "engine/scene/motion_builder.h"
#include "engine/scene/shapes.h"

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

// Meters. The carousel's axis is x = z = 0.
constexpr double PERIOD = 8; // seconds
constexpr float HALL = 6.0f, HEIGHT = 5.2f;
constexpr float DISC = 2.0f, DECK = 0.26f, ROOF = 2.4f;
constexpr float SEAT = 1.35f; // from the axis
constexpr int SECTORS = 12;

glm::vec3 around(float radius, float height, double turns)
{
    const auto angle = static_cast<float>(2 * PI * turns);
    return {radius * std::sin(angle), height, radius * std::cos(angle)};
}

glm::dmat4 turned(double turns)
{
    return glm::rotate(glm::dmat4(1), 2 * PI * turns, UP);
}

// What stands still.
void addHall(Scene& scene)
{
    const uint32_t plaster = addMaterial(scene, diffuse("plaster", {0.70f, 0.68f, 0.64f}));
    const uint32_t stone = addMaterial(scene, diffuse("stone", {0.60f, 0.57f, 0.52f}));
    const uint32_t tiles[] = {addMaterial(scene, glossy("dark tile", {0.10f, 0.095f, 0.09f}, 0.25f)),
                              addMaterial(scene, glossy("light tile", {0.50f, 0.48f, 0.45f}, 0.25f))};
    const uint32_t lantern = addMaterial(scene, emitter("lantern", {24, 8, 0.8f}));

    const float side = 2 * HALL, tile = side / 12;
    for (int column = 0; column < 12; ++column) {
        for (int row = 0; row < 12; ++row)
            addQuad(scene, tiles[(row + column) % 2],
                    {-HALL + tile * static_cast<float>(column), 0, -HALL + tile * static_cast<float>(row)},
                    {0, 0, tile}, {tile, 0, 0});
    }
    addQuad(scene, plaster, {-HALL, HEIGHT, -HALL}, {side, 0, 0}, {0, 0, side});
    for (const double quarter : {0.0, 0.25, 0.5, 0.75}) {
        const glm::dmat4 wall = turned(quarter);
        addQuad(scene, plaster, glm::vec3(wall * glm::dvec4(-HALL, 0, -HALL, 1)),
                glm::vec3(wall * glm::dvec4(side, 0, 0, 0)), {0, HEIGHT, 0});
    }
    const glm::vec2 column[] = {{0, 0},        {0.34f, 0},    {0.34f, 0.18f},  {0.22f, 0.3f},
                                {0.19f, 4.3f}, {0.34f, 4.8f}, {0.34f, HEIGHT}, {0, HEIGHT}};
    for (const float x : {-4.8f, -1.7f, 1.7f, 4.8f}) addLathe(scene, stone, {x, 0, -4.8f}, column, 16);
    for (const float x : {-4.8f, 4.8f}) {
        for (const float z : {-1.7f, 1.7f}) addLathe(scene, stone, {x, 0, z}, column, 16);
    }
    for (const float x : {-3.25f, 3.25f}) addSphere(scene, lantern, {x, 2.4f, -5.4f}, 0.13f, 1);
}

// A piece of a disc or a cone, its tip on the axis.
Scene sector(float radius, float edge, float tip)
{
    Scene shape;
    addSurface(shape, 0, {4, 1}, [&](float s, float t) {
        return around(radius * (1 - t), edge + t * (tip - edge), double(s) / SECTORS);
    });
    return shape;
}

Scene ball(float radius, uint32_t subdivisions)
{
    Scene shape;
    addSphere(shape, 0, {0, 0, 0}, radius, subdivisions);
    return shape;
}

Scene ring(float radius, float thickness)
{
    Scene shape;
    addSurface(shape, 0, {32, 12, true}, [&](float s, float t) {
        const auto angle = static_cast<float>(2 * PI * t); // once around the tube
        return around(radius - thickness * std::cos(angle), thickness * std::sin(angle), s);
    });
    return shape;
}

Scene lathe(std::span<const glm::vec2> profile, uint32_t segments)
{
    Scene shape;
    addLathe(shape, 0, {0, 0, 0}, profile, segments);
    return shape;
}

glm::dmat4 moved(const glm::dvec3& by)
{
    return glm::translate(glm::dmat4(1), by);
}

struct Palette {
    uint32_t ivory, lacquer, chalk, brass, mirror, ember;
    uint32_t red, green, blue, warm; // bulbs
};

Palette addPalette(Scene& scene)
{
    return {
        .ivory = addMaterial(scene, glossy("ivory", {0.76f, 0.72f, 0.64f}, 0.4f)),
        .lacquer = addMaterial(scene, glossy("lacquer", {0.42f, 0.05f, 0.05f}, 0.2f)),
        .chalk = addMaterial(scene, diffuse("chalk", {0.78f, 0.77f, 0.74f})),
        .brass = addMaterial(
            scene, {.name = "brass", .baseColor = {0.80f, 0.58f, 0.28f, 1}, .metallic = 1, .roughness = 0.3f}),
        .mirror = addMaterial(
            scene, {.name = "mirror", .baseColor = {0.84f, 0.84f, 0.84f, 1}, .metallic = 1, .roughness = 0.12f}),
        .ember = addMaterial(scene, emitter("ember", {12, 2.4f, 0.1f})),
        .red = addMaterial(scene, emitter("red bulb", {180, 0.2f, 0.1f})),
        .green = addMaterial(scene, emitter("green bulb", {0.3f, 110, 0.5f})),
        .blue = addMaterial(scene, emitter("blue bulb", {0.2f, 0.8f, 280})),
        .warm = addMaterial(scene, emitter("warm bulb", {40, 9, 0.3f})),
    };
}

// Turns once. Returns its node.
uint32_t addCarousel(MotionBuilder& builder, const Palette& palette)
{
    const uint32_t carousel = builder.addNode({});
    builder.turn(carousel, UP, 1);
    const glm::vec2 rim[] = {{DISC, 0}, {DISC, DECK - 0.02f}, {DISC - 0.05f, DECK}};
    const glm::vec2 eaves[] = {{0, ROOF}, {DISC, ROOF}, {DISC + 0.04f, ROOF + 0.1f}};
    const glm::vec2 pillar[] = {{0.3f, DECK}, {0.3f, 0.5f}, {0.16f, 0.62f}, {0.16f, ROOF}};
    builder.addPart(carousel, builder.addMesh(lathe(rim, 48)), palette.brass);
    builder.addPart(carousel, builder.addMesh(lathe(eaves, 48)), palette.ivory);
    builder.addPart(carousel, builder.addMesh(lathe(pillar, 24)), palette.brass);
    const uint32_t deck = builder.addMesh(sector(DISC - 0.05f, DECK, DECK));
    const uint32_t roof = builder.addMesh(sector(DISC + 0.04f, ROOF + 0.1f, ROOF + 1.15f));
    for (int i = 0; i < SECTORS; ++i)
        for (const uint32_t mesh : {deck, roof})
            builder.addPart(carousel, mesh, i % 2 == 0 ? palette.ivory : palette.lacquer, turned(double(i) / SECTORS));
    return carousel;
}

// On its six seats: some stand, one turns about its own axis, two go up and down on their poles.
void addBodies(MotionBuilder& builder, const Palette& palette, uint32_t carousel)
{
    std::vector<uint32_t> seats;
    for (int i = 0; i < 6; ++i) seats.push_back(builder.addNode({.translation = around(SEAT, 0, i / 6.0)}, carousel));
    Scene bar, box;
    addBar(bar, 0, {0, DECK, 0}, {0, ROOF, 0}, 0.025f);
    addBox(box, 0, glm::vec3(-0.3f), glm::vec3(0.3f));
    const glm::vec2 socket[] = {{0.26f, DECK}, {0.26f, 0.5f}, {0.2f, 0.56f}, {0, 0.56f}};
    const glm::vec2 vase[] = {{0, DECK},      {0.16f, DECK}, {0.3f, 0.5f},  {0.34f, 0.72f},
                              {0.26f, 0.96f}, {0.12f, 1.1f}, {0.2f, 1.24f}, {0, 1.1f}};
    const uint32_t pole = builder.addMesh(bar), plinth = builder.addMesh(lathe(socket, 24));
    for (const uint32_t seat : {seats[1], seats[3]}) builder.addPart(seat, pole, palette.brass);
    for (const uint32_t seat : {seats[0], seats[2], seats[5]}) builder.addPart(seat, plinth, palette.ivory);

    builder.addPart(seats[0], builder.addMesh(ball(0.4f, 3)), palette.mirror, moved({0, 0.95, 0}));
    builder.addPart(seats[4], builder.addMesh(lathe(vase, 24)), palette.ivory);
    builder.addPart(seats[5], builder.addMesh(ball(0.34f, 2)), palette.chalk, moved({0, 0.9, 0}));

    const uint32_t spinning = builder.addNode({.translation = {0, 1.1, 0}}, seats[2]);
    builder.turn(spinning, UP, -3);
    const glm::dmat4 onItsCorner =
        glm::rotate(glm::rotate(glm::dmat4(1), std::atan(std::sqrt(0.5)), {1, 0, 0}), PI / 4, {0, 0, 1});
    builder.addPart(spinning, builder.addMesh(box), palette.chalk, onItsCorner);

    const auto bob = [&](uint32_t seat, double from, double to) {
        const uint32_t node = builder.addNode({}, seat);
        builder.translate(node, 4, [&](double phase) {
            return (0.5 * (from + to) + 0.5 * (from - to) * std::cos(2 * PI * phase)) * UP;
        });
        return node;
    };
    builder.addPart(bob(seats[1], 0.7, 1.7), builder.addMesh(ring(0.34f, 0.11f)), palette.lacquer);
    builder.addPart(bob(seats[3], 1.6, 0.8), builder.addMesh(ball(0.2f, 2)), palette.ember);
}

void addLamps(MotionBuilder& builder, const Palette& palette)
{
    // Bulbs under the eaves run against the carousel; two more run around it, close to the ground.
    const uint32_t garland = builder.addNode({}), runners = builder.addNode({});
    builder.turn(garland, UP, -1);
    builder.turn(runners, UP, -2);
    const uint32_t bulb = builder.addMesh(ball(0.09f, 1));
    const uint32_t colors[] = {palette.red, palette.green, palette.blue};
    for (int i = 0; i < SECTORS; ++i)
        builder.addPart(garland, bulb, colors[i * 3 / SECTORS],
                        moved(around(DISC + 0.1f, ROOF - 0.18f, double(i) / SECTORS)));
    builder.addPart(runners, bulb, palette.blue, moved(around(DISC + 0.5f, 0.4f, 0)));
    builder.addPart(runners, bulb, palette.warm, moved(around(DISC + 0.5f, 0.4f, 0.5)));

    // Two spotlights sweep the hall.
    for (const int sign : {-1, 1}) {
        const uint32_t mast = builder.addNode({.translation = {sign * 3.6, 4.8, -2.6}});
        builder.turn(mast, UP, sign);
        const uint32_t head = builder.addNode({.rotation = glm::angleAxis(-PI / 3, glm::dvec3(1, 0, 0))}, mast);
        builder.addLight(head, {.name = "sweep",
                                .kind = LightKind::Spot,
                                .intensity = sign < 0 ? glm::vec3(1, 2, 110) : glm::vec3(100, 1.5f, 12),
                                .innerConeAngle = glm::radians(14.0f),
                                .outerConeAngle = glm::radians(24.0f)});
    }
}

} // namespace

Scene makeCarousel()
{
    Scene scene;
    scene.name = "carousel";
    addHall(scene);
    const Palette palette = addPalette(scene);
    MotionBuilder builder(scene, PERIOD);
    addBodies(builder, palette, addCarousel(builder, palette));
    addLamps(builder, palette);
    builder.finish();
    scene.cameras.push_back(lookAt("visitor", {0.4, 1.8, 5.6}, {0, 1.45, 0}, 46.0));
    return scene;
}

} // namespace scene
