// The built-in scene "dim".
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

// Meters: the room spans x 0..5.2, z 0..4.4; its doorway is in the wall x = 0, the corridor behind it.
constexpr float WIDTH = 5.2f, DEPTH = 4.4f, HEIGHT = 2.7f;
constexpr float DOOR_NEAR = 2.3f, DOOR_FAR = 1.2f, DOOR_HEIGHT = 2.1f, WALL = 0.16f;
constexpr float CORRIDOR = 1.5f;

struct Palette {
    uint32_t wall, ceiling, boards, darkBoards, trim, wood, cushion, sofa, rug, rugBorder, brass, vase, glaze;
    std::vector<uint32_t> books;
};

void addRoom(Scene& scene, const Palette& palette, uint32_t lamp)
{
    // Floor boards along x, in the room and the corridor.
    const float board = 0.2f;
    for (int i = 0; i < 22; ++i) // 4.4 m
        addQuad(scene, i % 3 == 1 ? palette.darkBoards : palette.boards,
                {-CORRIDOR - WALL, 0, board * static_cast<float>(i)}, {0, 0, board}, {WIDTH + CORRIDOR + WALL, 0, 0});
    addQuad(scene, palette.ceiling, {-CORRIDOR - WALL, HEIGHT, 0}, {WIDTH + CORRIDOR + WALL, 0, 0}, {0, 0, DEPTH});
    const glm::vec3 up(0, HEIGHT, 0);
    addQuad(scene, palette.wall, {WIDTH, 0, DEPTH}, {0, 0, -DEPTH}, up);                         // right
    addQuad(scene, palette.wall, {-CORRIDOR - WALL, 0, 0}, {WIDTH + CORRIDOR + WALL, 0, 0}, up); // back
    addQuad(scene, palette.wall, {WIDTH, 0, DEPTH}, {-WIDTH - CORRIDOR - WALL, 0, 0}, up);       // behind the camera
    addQuad(scene, palette.ceiling, {-CORRIDOR - WALL, 0, DEPTH}, {0, 0, -DEPTH}, up);           // corridor's far wall
    // The wall with the doorway: two piers and a lintel, 16 cm thick.
    addBox(scene, palette.wall, {-WALL, 0, 0}, {0, HEIGHT, DOOR_FAR});
    addBox(scene, palette.wall, {-WALL, 0, DOOR_NEAR}, {0, HEIGHT, DEPTH});
    addBox(scene, palette.wall, {-WALL, DOOR_HEIGHT, DOOR_FAR}, {0, HEIGHT, DOOR_NEAR});
    const float frame = 0.07f;
    addBox(scene, palette.trim, {-WALL - 0.01f, 0, DOOR_FAR}, {0.02f, DOOR_HEIGHT, DOOR_FAR + frame});
    addBox(scene, palette.trim, {-WALL - 0.01f, 0, DOOR_NEAR - frame}, {0.02f, DOOR_HEIGHT, DOOR_NEAR});
    addBox(scene, palette.trim, {-WALL - 0.01f, DOOR_HEIGHT - frame, DOOR_FAR}, {0.02f, DOOR_HEIGHT, DOOR_NEAR});
    // Skirting boards.
    addBox(scene, palette.trim, {0, 0, 0}, {WIDTH, 0.1f, 0.015f});
    addBox(scene, palette.trim, {WIDTH - 0.015f, 0, 0.015f}, {WIDTH, 0.1f, DEPTH});
    // The only light: a panel under the corridor's ceiling, out of sight beside the doorway.
    addQuad(scene, lamp, {-WALL - 1.3f, HEIGHT - 0.01f, DEPTH - 1.5f}, {1.1f, 0, 0}, {0, 0, 1.2f});
}

void addShelf(Scene& scene, const Palette& palette, float left, float right)
{
    const float depth = 0.3f, top = 2.0f;
    for (const float x : {left, right - 0.03f}) addBox(scene, palette.wood, {x, 0, 0.02f}, {x + 0.03f, top, depth});
    uint32_t seed = 12345;
    const auto next = [&] { // a linear congruential generator (Numerical Recipes), upper bits
        seed = seed * 1664525u + 1013904223u;
        return static_cast<float>(seed >> 8) / 16777216.0f;
    };
    for (int shelf = 0; shelf <= 5; ++shelf) {
        const float y = 0.06f + 0.38f * static_cast<float>(shelf);
        addBox(scene, palette.wood, {left + 0.03f, y, 0.02f}, {right - 0.03f, y + 0.025f, depth});
        if (shelf == 5) break;
        float x = left + 0.05f;
        while (x < right - 0.12f) {
            const float thickness = 0.02f + 0.035f * next(), height = 0.2f + 0.12f * next(),
                        reach = 0.16f + 0.07f * next();
            if (next() < 0.13f) {
                x += 0.1f + 0.12f * next(); // a gap
                continue;
            }
            addBox(scene, palette.books[static_cast<size_t>(next() * static_cast<float>(palette.books.size()))],
                   {x, y + 0.025f, 0.04f}, {x + thickness, y + 0.025f + height, 0.04f + reach});
            x += thickness + 0.003f;
        }
    }
}

// A superellipsoid between a box and a ball: cushions.
void addCushion(Scene& scene, uint32_t material, const glm::mat4& transform, float softness)
{
    const auto power = [&](float v) { return std::copysign(std::pow(std::abs(v), softness), v); };
    addSurface(scene, material, {40, 20, true}, [&](float s, float t) {
        const float a = 2 * PI * s;
        const float ring = power(std::sin(PI * std::min(t, 1 - t))); // exactly 0 at both poles
        const glm::vec3 p(ring * power(std::sin(a)), -power(std::cos(PI * t)), ring * power(std::cos(a)));
        return glm::vec3(transform * glm::vec4(p, 1));
    });
}

glm::mat4 placed(glm::vec3 center, glm::vec3 half, float degrees = 0, glm::vec3 axis = {0, 1, 0})
{
    return glm::scale(glm::rotate(glm::translate(glm::mat4(1), center), glm::radians(degrees), axis), half);
}

void addSofa(Scene& scene, const Palette& palette)
{
    const float back = WIDTH - 0.12f; // against the right wall, facing -x
    addCushion(scene, palette.sofa, placed({back - 0.45f, 0.24f, 2.0f}, {0.45f, 0.14f, 1.0f}), 0.18f);
    addCushion(scene, palette.sofa, placed({back - 0.12f, 0.55f, 2.0f}, {0.14f, 0.38f, 1.0f}, -8, {0, 0, 1}), 0.25f);
    for (const float z : {1.02f, 2.98f})
        addCushion(scene, palette.sofa, placed({back - 0.45f, 0.36f, z}, {0.45f, 0.26f, 0.12f}), 0.25f);
    for (const float z : {1.56f, 2.44f})
        addCushion(scene, palette.sofa, placed({back - 0.52f, 0.45f, z}, {0.37f, 0.09f, 0.42f}), 0.3f);
    addCushion(scene, palette.cushion, placed({back - 0.36f, 0.72f, 1.4f}, {0.08f, 0.2f, 0.2f}, -20, {0, 0, 1}), 0.5f);
}

void addTable(Scene& scene, const Palette& palette)
{
    const glm::vec3 at(2.75f, 0, 1.9f);
    const glm::vec2 top[] = {{0, 0.40f}, {0.5f, 0.40f}, {0.52f, 0.42f}, {0.5f, 0.44f}, {0, 0.44f}};
    addLathe(scene, palette.wood, at, top, 40);
    for (int i = 0; i < 3; ++i) {
        const float a = 2 * PI * static_cast<float>(i) / 3 + 0.3f;
        const glm::vec3 side(std::cos(a), 0, std::sin(a));
        addBar(scene, palette.wood, at + 0.42f * side, at + 0.3f * side + glm::vec3(0, 0.41f, 0), 0.022f, 12);
    }
    // A vase, thrown in one curve, and a bowl.
    addSurface(scene, palette.vase, {32, 28, true}, [&](float s, float t) {
        const float r = t < 0.03f ? 0.055f * t / 0.03f
                                  : 0.055f + 0.05f * std::sin(2.6f * PI * std::pow(t, 0.8f) - 0.6f) * (1 - 0.5f * t) +
                                        0.028f * (1 - t);
        return at + glm::vec3(-0.12f + r * std::sin(2 * PI * s), 0.44f + 0.3f * t, -0.1f + r * std::cos(2 * PI * s));
    });
    const glm::vec2 bowl[] = {{0, 0.44f},       {0.05f, 0.44f},  {0.1f, 0.47f}, {0.13f, 0.51f},
                              {0.125f, 0.512f}, {0.095f, 0.48f}, {0, 0.46f}};
    addLathe(scene, palette.glaze, at + glm::vec3(0.18f, 0, 0.16f), bowl, 28);
}

} // namespace

Scene makeDim()
{
    Scene scene;
    scene.name = "dim";
    Palette palette;
    palette.wall = addMaterial(scene, diffuse("wall", {0.62f, 0.58f, 0.50f}));
    palette.ceiling = addMaterial(scene, diffuse("ceiling", {0.80f, 0.79f, 0.76f}));
    palette.boards = addMaterial(scene, glossy("boards", {0.38f, 0.22f, 0.12f}, 0.3f));
    palette.darkBoards = addMaterial(scene, glossy("dark boards", {0.32f, 0.18f, 0.10f}, 0.34f));
    palette.trim = addMaterial(scene, diffuse("trim", {0.76f, 0.75f, 0.72f}));
    palette.wood = addMaterial(scene, glossy("walnut", {0.24f, 0.13f, 0.07f}, 0.35f));
    palette.sofa = addMaterial(scene, diffuse("sofa", {0.13f, 0.25f, 0.27f}));
    palette.cushion = addMaterial(scene, diffuse("cushion", {0.70f, 0.42f, 0.10f}));
    palette.rug = addMaterial(scene, diffuse("rug", {0.42f, 0.10f, 0.09f}));
    palette.rugBorder = addMaterial(scene, diffuse("rug border", {0.62f, 0.52f, 0.36f}));
    palette.brass =
        addMaterial(scene, {.name = "brass", .baseColor = {0.8f, 0.6f, 0.3f, 1}, .metallic = 1, .roughness = 0.3f});
    palette.vase = addMaterial(scene, glossy("vase", {0.16f, 0.30f, 0.50f}, 0.12f));
    palette.glaze = addMaterial(scene, glossy("glaze", {0.75f, 0.73f, 0.68f}, 0.1f));
    for (const glm::vec3 color :
         {glm::vec3(0.35f, 0.07f, 0.06f), glm::vec3(0.08f, 0.16f, 0.30f), glm::vec3(0.11f, 0.22f, 0.12f),
          glm::vec3(0.55f, 0.46f, 0.30f), glm::vec3(0.25f, 0.20f, 0.16f), glm::vec3(0.48f, 0.24f, 0.08f)})
        palette.books.push_back(addMaterial(scene, diffuse("book", color)));
    const uint32_t lamp = addMaterial(scene, emitter("lamp", {14, 14, 14}));

    addRoom(scene, palette, lamp);
    addShelf(scene, palette, 0.5f, 2.1f);
    addSofa(scene, palette);
    addTable(scene, palette);
    addBox(scene, palette.rugBorder, {1.6f, 0, 0.9f}, {4.0f, 0.012f, 2.9f});
    addBox(scene, palette.rug, {1.72f, 0.012f, 1.02f}, {3.88f, 0.016f, 2.78f});
    // Framed pictures on the back wall.
    const std::array<glm::vec3, 3> art = {{{0.55f, 0.30f, 0.12f}, {0.15f, 0.32f, 0.40f}, {0.45f, 0.47f, 0.30f}}};
    for (size_t i = 0; i < art.size(); ++i) {
        const float x = 2.65f + 0.72f * static_cast<float>(i), y = 1.35f, half = 0.26f;
        addBox(scene, palette.wood, {x - half, y - 0.34f, 0}, {x + half, y + 0.34f, 0.03f});
        addBox(scene, palette.trim, {x - half + 0.03f, y - 0.31f, 0.03f}, {x + half - 0.03f, y + 0.31f, 0.033f});
        addBox(scene, addMaterial(scene, diffuse("print", art[i])), {x - 0.14f, y - 0.2f, 0.033f},
               {x + 0.14f, y + 0.2f, 0.036f});
    }
    // A floor lamp, switched off.
    const glm::vec3 at(4.7f, 0, 0.5f);
    const glm::vec2 foot[] = {{0, 0},          {0.15f, 0},      {0.15f, 0.02f}, {0.02f, 0.035f},
                              {0.012f, 0.05f}, {0.012f, 1.45f}, {0, 1.45f}};
    addLathe(scene, palette.brass, at, foot, 24);
    addSurface(scene, palette.trim, {32, 1, true}, [&](float s, float t) {
        const float r = 0.24f - 0.09f * t;
        return at + glm::vec3(r * std::sin(2 * PI * s), 1.35f + 0.3f * t, r * std::cos(2 * PI * s));
    });

    scene.cameras.push_back(lookAt("from the corner", {4.3, 1.5, 4.2}, {1.95, 0.95, 0.9}, 56.0));
    return scene;
}

} // namespace scene
