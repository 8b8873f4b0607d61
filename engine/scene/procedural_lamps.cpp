// The built-in scene "lamps".
#include "engine/scene/procedural.h"

#include "engine/scene/shapes.h"

#include <array>
#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

namespace scene
{

namespace
{

constexpr float PI = std::numbers::pi_v<float>;

// A deterministic number in [0, 1) (an integer hash, Jenkins' one-at-a-time on one word).
float hashed(uint32_t x)
{
    x += x << 10;
    x ^= x >> 6;
    x += x << 3;
    x ^= x >> 11;
    x += x << 15;
    return static_cast<float>(x >> 8) / 16777216.0f;
}

struct Palette {
    std::vector<uint32_t> bulbs, windows, walls;
    uint32_t paving, joint, wood, iron, linen, pot, leaf;
};

Palette addPalette(Scene& scene)
{
    Palette palette;
    const std::array<glm::vec3, 7> hues = {{{1, 0.08f, 0.05f},
                                            {1, 0.42f, 0.04f},
                                            {0.9f, 0.75f, 0.1f},
                                            {0.1f, 0.9f, 0.2f},
                                            {0.05f, 0.6f, 0.95f},
                                            {0.2f, 0.15f, 1},
                                            {0.95f, 0.1f, 0.7f}}};
    for (const glm::vec3& hue : hues) palette.bulbs.push_back(addMaterial(scene, emitter("bulb", 55.0f * hue)));
    palette.windows = {addMaterial(scene, emitter("warm window", {2.2f, 1.15f, 0.35f})),
                       addMaterial(scene, emitter("teal window", {0.15f, 0.9f, 0.8f})),
                       addMaterial(scene, emitter("violet window", {0.8f, 0.25f, 1.3f}))};
    palette.walls = {addMaterial(scene, diffuse("cream plaster", {0.68f, 0.60f, 0.48f})),
                     addMaterial(scene, diffuse("rose plaster", {0.62f, 0.40f, 0.36f})),
                     addMaterial(scene, diffuse("grey plaster", {0.50f, 0.52f, 0.55f}))};
    palette.paving = addMaterial(scene, glossy("paving", {0.22f, 0.21f, 0.20f}, 0.3f));
    palette.joint = addMaterial(scene, diffuse("joint", {0.08f, 0.075f, 0.07f}));
    palette.wood = addMaterial(scene, glossy("wood", {0.36f, 0.20f, 0.10f}, 0.4f));
    palette.iron = addMaterial(scene, glossy("iron", {0.05f, 0.05f, 0.055f}, 0.35f));
    palette.linen = addMaterial(scene, diffuse("linen", {0.80f, 0.78f, 0.74f}));
    palette.pot = addMaterial(scene, diffuse("clay", {0.50f, 0.22f, 0.12f}));
    palette.leaf = addMaterial(scene, diffuse("leaf", {0.10f, 0.27f, 0.07f}));
    return palette;
}

void addPaving(Scene& scene, const Palette& palette)
{
    addQuad(scene, palette.joint, {-20, 0, 12}, {40, 0, 0}, {0, 0, -40});
    const float size = 0.8f;
    for (int row = 0; row < 22; ++row)
        for (int column = 0; column < 18; ++column) {
            const float shift = row % 2 == 0 ? 0 : size / 2;
            const glm::vec3 corner(-7.2f + shift + size * static_cast<float>(column), 0,
                                   4 - size * static_cast<float>(row));
            addBox(scene, palette.paving, corner, corner + glm::vec3(size - 0.03f, 0.02f, size - 0.03f));
        }
}

// A house with rows of windows on its face (the face looks along `facing`, a unit axis in the ground plane).
void addHouse(Scene& scene, const Palette& palette, glm::vec3 low, glm::vec3 high, glm::vec3 facing, uint32_t tone)
{
    addBox(scene, palette.walls[tone % 3], low, high);
    const glm::vec3 along = glm::cross(glm::vec3(0, 1, 0), facing); // x facing -> up
    const glm::vec3 center = 0.5f * (low + high), half = 0.5f * (high - low);
    const float width = std::abs(glm::dot(along, half)), depth = std::abs(glm::dot(facing, half));
    const int columns = static_cast<int>(width * 2 / 1.5f), floors = static_cast<int>((high.y - low.y) / 2.6f);
    for (int floor = 0; floor < floors; ++floor)
        for (int column = 0; column < columns; ++column) {
            const uint32_t key = tone * 977 + static_cast<uint32_t>(floor * 31 + column) * 7919;
            const float s = (static_cast<float>(column) + 0.5f) / static_cast<float>(columns) * 2 - 1;
            const glm::vec3 middle = glm::vec3(center.x, low.y + 1.55f + 2.6f * static_cast<float>(floor), center.z) +
                                     s * (width - 0.2f) * along + (depth + 0.01f) * facing;
            const glm::vec3 w = 0.4f * along, h(0, 0.65f, 0);
            if (hashed(key) < 0.45f)
                addQuad(scene, palette.windows[static_cast<size_t>(hashed(key + 1) * 3)], middle - w - h, 2.0f * w,
                        2.0f * h);
            else
                addQuad(scene, palette.iron, middle - w - h, 2.0f * w, 2.0f * h);
            const glm::vec3 sill = middle - h - glm::vec3(0, 0.05f, 0);
            const glm::vec3 reach = glm::abs(1.2f * w) + glm::abs(0.09f * facing) + glm::vec3(0, 0.04f, 0);
            addBox(scene, palette.linen, sill - reach, sill + reach);
        }
}

// A hanging chain of bulbs, each of the next color.
void addGarland(Scene& scene, const Palette& palette, glm::vec3 from, glm::vec3 to, int count, uint32_t tone)
{
    const auto chain = [&](float s) { return glm::mix(from, to, s) - glm::vec3(0, 3.2f * s * (1 - s), 0); };
    const int steps = 24;
    for (int i = 0; i < steps; ++i)
        addBar(scene, palette.iron, chain(static_cast<float>(i) / steps), chain(static_cast<float>(i + 1) / steps),
               0.008f, 5);
    for (int i = 0; i < count; ++i) {
        const float s = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
        const size_t color = (tone + static_cast<uint32_t>(i) * 3) % palette.bulbs.size();
        addSphere(scene, palette.bulbs[color], chain(s) - glm::vec3(0, 0.06f, 0), 0.05f, 1);
    }
}

void addTable(Scene& scene, const Palette& palette, glm::vec3 at, uint32_t tone)
{
    const glm::vec2 foot[] = {{0, 0},         {0.26f, 0},     {0.26f, 0.03f}, {0.05f, 0.07f},
                              {0.04f, 0.68f}, {0.12f, 0.71f}, {0, 0.71f}};
    addLathe(scene, palette.iron, at, foot, 20);
    const glm::vec2 top[] = {{0, 0.71f}, {0.44f, 0.71f}, {0.46f, 0.725f}, {0.44f, 0.74f}, {0, 0.74f}};
    addLathe(scene, palette.wood, at, top, 32);
    // A lantern: a colored flame between a foot and a cap.
    const glm::vec2 base[] = {{0, 0.74f}, {0.08f, 0.74f}, {0.08f, 0.76f}, {0, 0.76f}};
    addLathe(scene, palette.iron, at, base, 16);
    addSphere(scene, palette.bulbs[tone % palette.bulbs.size()], at + glm::vec3(0, 0.82f, 0), 0.05f, 2);
    const glm::vec2 cap[] = {{0, 0.9f}, {0.08f, 0.9f}, {0.02f, 0.95f}, {0, 0.95f}};
    addLathe(scene, palette.iron, at, cap, 16);
    for (int i = 0; i < 3; ++i) {
        const float angle = 2 * PI * static_cast<float>(i) / 3 + static_cast<float>(tone);
        const glm::vec3 side(0.072f * std::cos(angle), 0, 0.072f * std::sin(angle));
        addBar(scene, palette.iron, at + side + glm::vec3(0, 0.76f, 0), at + side + glm::vec3(0, 0.9f, 0), 0.005f, 6);
    }
    // A cup and a plate.
    const glm::vec2 plate[] = {{0, 0.74f}, {0.07f, 0.742f}, {0.11f, 0.757f}, {0.07f, 0.748f}, {0, 0.747f}};
    addLathe(scene, palette.linen, at + glm::vec3(0.2f, 0, 0.14f), plate, 20);
    // Chairs on both sides.
    for (const float angle : {0.4f + static_cast<float>(tone), 0.4f + static_cast<float>(tone) + PI}) {
        const glm::mat4 seat = glm::rotate(glm::translate(glm::mat4(1), at), angle, {0, 1, 0});
        const auto addPart = [&](glm::vec3 center, glm::vec3 half) {
            addBox(scene, palette.wood, glm::scale(glm::translate(seat, center), half));
        };
        addPart({0.75f, 0.45f, 0}, {0.2f, 0.015f, 0.2f});
        for (const float x : {0.57f, 0.93f})
            for (const float z : {-0.18f, 0.18f}) addPart({x, 0.22f, z}, {0.015f, 0.22f, 0.015f});
        for (const float y : {0.62f, 0.74f, 0.86f}) addPart({0.94f, y, 0}, {0.01f, 0.03f, 0.19f});
        for (const float z : {-0.18f, 0.18f}) addPart({0.94f, 0.67f, z}, {0.012f, 0.22f, 0.012f});
    }
}

void addShrub(Scene& scene, const Palette& palette, glm::vec3 at)
{
    const glm::vec2 pot[] = {{0, 0},         {0.2f, 0},      {0.28f, 0.42f}, {0.31f, 0.42f},
                             {0.31f, 0.48f}, {0.25f, 0.48f}, {0, 0.44f}};
    addLathe(scene, palette.pot, at, pot, 24);
    addSurface(scene, palette.leaf, {48, 24, true}, [&](float s, float t) { // a clipped, bumpy ball
        const float bump = 1 + 0.07f * std::sin(14 * PI * s) * std::sin(9 * PI * t);
        const float r = 0.42f * bump * std::sin(PI * t);
        return at +
               glm::vec3(r * std::sin(2 * PI * s), 0.86f - 0.42f * bump * std::cos(PI * t), r * std::cos(2 * PI * s));
    });
}

} // namespace

Scene makeLamps()
{
    Scene scene;
    scene.name = "lamps";
    const Palette palette = addPalette(scene);
    addPaving(scene, palette);

    addHouse(scene, palette, {-10.5f, 0, -10}, {-6, 8.2f, 3}, {1, 0, 0}, 0);
    addHouse(scene, palette, {6.5f, 0, -9}, {11, 6.6f, 3}, {-1, 0, 0}, 1);
    addHouse(scene, palette, {-6, 0, -17}, {0.5f, 9.4f, -12.5f}, {0, 0, 1}, 2);
    addHouse(scene, palette, {0.5f, 0, -18}, {8, 6.8f, -13.2f}, {0, 0, 1}, 3);

    for (uint32_t i = 0; i < 8; ++i) {
        const float z = 0.5f - 1.7f * static_cast<float>(i);
        addGarland(scene, palette, {-6, 4.6f + 0.3f * hashed(i), z},
                   {6.5f, 4.4f + 0.5f * hashed(i + 50), z - 1.5f + 2 * hashed(i + 90)}, 34, i);
    }
    const std::array<glm::vec2, 9> tables = {{{-3.6f, -0.9f},
                                              {-0.6f, -2.3f},
                                              {2.6f, -1.2f},
                                              {-3.9f, -4.6f},
                                              {0.4f, -5.6f},
                                              {3.9f, -4.4f},
                                              {-2.0f, -8.2f},
                                              {2.2f, -8.8f},
                                              {4.6f, -7.6f}}};
    for (uint32_t i = 0; i < tables.size(); ++i) addTable(scene, palette, {tables[i].x, 0.02f, tables[i].y}, i);
    for (const float z : {-2.6f, -6.2f, -9.8f}) {
        addShrub(scene, palette, {-5.4f, 0.02f, z});
        addShrub(scene, palette, {5.9f, 0.02f, z + 0.8f});
    }

    scene.environment = {1, 2, {{0.010f, 0.014f, 0.035f}, {0.0f, 0.0f, 0.0f}}}; // night sky
    scene.cameras.push_back(lookAt("terrace", {0.4, 1.75, 3.4}, {-0.1, 1.75, -6}, 56.0));
    return scene;
}

} // namespace scene
