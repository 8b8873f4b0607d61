// The built-in scene "hall".
#include "engine/scene/procedural.h"

#include "engine/scene/shapes.h"

#include <cmath>
#include <numbers>

namespace scene
{

namespace
{

constexpr float PI = std::numbers::pi_v<float>;

// Meters. The nave runs along -z, columns and arches on both sides, aisles behind them.
constexpr int BAYS = 7;
constexpr float BAY = 3.8f;             // along z
constexpr float NAVE = 3.2f;            // from the axis to the columns' centers
constexpr float AISLE_WALL = 5.8f;      // from the axis
constexpr float HALF_THICKNESS = 0.34f; // of the wall above the arches
constexpr float SPRING = 3.5f;          // where arches start
constexpr float ARCH_RADIUS = 1.48f;
constexpr float AISLE_HEIGHT = 5.5f;
constexpr float NAVE_HEIGHT = 6.3f; // where the vault starts
constexpr float FRONT = 3.0f;       // z of the wall behind the camera
constexpr float BACK = -BAYS * BAY;

struct Palette {
    uint32_t stone, plaster, darkTile, lightTile, brass, window;
    std::vector<uint32_t> cloths;
};

float bayCenter(int bay)
{
    return -(static_cast<float>(bay) + 0.5f) * BAY;
}

void addColumn(Scene& scene, const Palette& palette, glm::vec3 base)
{
    const glm::vec2 profile[] = {{0, 0},         {0.5f, 0},      {0.5f, 0.16f},  {0.42f, 0.22f}, {0.42f, 0.3f},
                                 {0.34f, 0.36f}, {0.32f, 1.2f},  {0.29f, 2.9f},  {0.34f, 2.95f}, {0.34f, 3.02f},
                                 {0.3f, 3.06f},  {0.46f, 3.32f}, {0.5f, SPRING}, {0, SPRING}};
    addLathe(scene, palette.stone, base, profile, 24);
}

// The wall above one arch, on the side x = sign * NAVE: its two faces and the arch's underside.
void addArch(Scene& scene, const Palette& palette, float sign, int bay)
{
    const int steps = 24;
    const auto edge = [&](float s) { // (z, y) along the lower edge, front to back: pier, arch, pier
        const int i = static_cast<int>(std::lround(s * (steps + 2)));
        if (i == 0) return glm::vec2(BAY / 2, SPRING);
        if (i == steps + 2) return glm::vec2(-BAY / 2, SPRING);
        const float angle = PI * static_cast<float>(i - 1) / steps;
        return glm::vec2(ARCH_RADIUS * std::cos(angle), SPRING + ARCH_RADIUS * std::sin(angle));
    };
    const float z = bayCenter(bay);
    const auto addFace = [&](float x, float top) {
        addSurface(scene, palette.plaster, {steps + 2, 4}, [&](float s, float t) {
            const glm::vec2 low = edge(s);
            return glm::vec3(x, low.y + t * (top - low.y), z + low.x);
        });
    };
    addFace(sign * (NAVE - HALF_THICKNESS), NAVE_HEIGHT);
    addFace(sign * (NAVE + HALF_THICKNESS), AISLE_HEIGHT);
    addSurface(scene, palette.stone, {steps + 2, 1}, [&](float s, float t) {
        return glm::vec3(sign * (NAVE + (2 * t - 1) * HALF_THICKNESS), edge(s).y, z + edge(s).x);
    });
}

// Half of a pair of curtains in an arch: fixed at the column, gathered by a tie, falling to the floor in folds.
void addCurtain(Scene& scene, uint32_t cloth, float x, float zColumn, float towardCenter)
{
    const float width = 1.42f, top = SPRING - 0.05f, bottom = 0.04f, tieHeight = 0.36f;
    const auto smooth = [](float a, float b, float v) {
        const float t = glm::clamp((v - a) / (b - a), 0.0f, 1.0f);
        return t * t * (3 - 2 * t);
    };
    addSurface(scene, cloth, {64, 12}, [&](float s, float t) {
        const float height = 1 - t; // of the rod above the floor
        const float gather =
            height > tieHeight ? smooth(1.02f, tieHeight, height) : 1 - 0.28f * smooth(tieHeight, 0, height);
        const float spread = 1 - 0.6f * std::pow(gather, 1.3f);
        // What the cloth loses in width it gains in depth of its folds.
        const float depth = 0.04f + 0.025f * gather;
        const float phase = 2 * PI * 5.0f * s + 1.7f * zColumn;
        const float fold = std::sin(phase + 0.5f * std::sin(0.5f * phase + 3 * height));
        const float sway = 0.01f * std::sin(2 * phase + 5 * height);
        const float sag = 0.03f * std::pow(std::abs(std::sin(phase / 2)), 2.0f) * smooth(0.9f, 1.0f, height);
        return glm::vec3(x + depth * fold + sway, bottom + height * (top - bottom) - sag,
                         zColumn + towardCenter * (0.3f + width * s * spread));
    });
}

void addShell(Scene& scene, const Palette& palette)
{
    // Floor: square tiles, corner to corner.
    const float tile = 0.95f;
    const int columns = static_cast<int>(std::ceil(2 * AISLE_WALL / tile)),
              rows = static_cast<int>(std::ceil((FRONT - BACK) / tile));
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            addQuad(scene, (row + column) % 2 == 0 ? palette.darkTile : palette.lightTile,
                    {-AISLE_WALL + tile * static_cast<float>(column), 0, FRONT - tile * static_cast<float>(row)},
                    {tile, 0, 0}, {0, 0, -tile});

    const float length = FRONT - BACK, vaultRadius = NAVE - HALF_THICKNESS;
    addSurface(scene, palette.plaster, {32, 2 * BAYS}, [&](float s, float t) { // vault
        return glm::vec3(-vaultRadius * std::cos(PI * s), NAVE_HEIGHT + vaultRadius * std::sin(PI * s),
                         FRONT - t * length);
    });
    for (int bay = 0; bay <= BAYS; ++bay) // its ribs
        addSurface(scene, palette.stone, {32, 6}, [&](float s, float t) {
            const float r = vaultRadius - 0.16f * std::sin(PI * t),
                        z = -BAY * static_cast<float>(bay) + 0.22f * std::cos(PI * t);
            return glm::vec3(-r * std::cos(PI * s), NAVE_HEIGHT + r * std::sin(PI * s), z);
        });
    for (const float sign : {-1.0f, 1.0f}) {
        const float wall = sign * AISLE_WALL, inner = sign * (NAVE + HALF_THICKNESS);
        addQuad(scene, palette.plaster, {wall, 0, FRONT}, {0, 0, -length}, {0, AISLE_HEIGHT, 0});
        addQuad(scene, palette.plaster, {wall, AISLE_HEIGHT, FRONT}, {0, 0, -length}, {inner - wall, 0, 0});
        // The walls beside the camera, in front of the first column.
        addQuad(scene, palette.plaster, {sign * (NAVE - HALF_THICKNESS), SPRING, FRONT}, {0, 0, -FRONT},
                {0, NAVE_HEIGHT - SPRING, 0});
        addQuad(scene, palette.plaster, {inner, SPRING, FRONT}, {0, 0, -FRONT}, {0, AISLE_HEIGHT - SPRING, 0});
        addQuad(scene, palette.stone, {sign * (NAVE - HALF_THICKNESS), SPRING, FRONT}, {0, 0, -FRONT},
                {sign * 2 * HALF_THICKNESS, 0, 0});
        // A cornice under the vault.
        addBox(scene, palette.stone,
               glm::min(glm::vec3(sign * (vaultRadius - 0.14f), NAVE_HEIGHT - 0.2f, BACK),
                        glm::vec3(sign * (vaultRadius + 0.1f), NAVE_HEIGHT, BACK)),
               glm::max(glm::vec3(sign * (vaultRadius - 0.14f), NAVE_HEIGHT, FRONT),
                        glm::vec3(sign * (vaultRadius + 0.1f), NAVE_HEIGHT, FRONT)));
    }
    for (const float z : {FRONT, BACK})
        addQuad(scene, palette.plaster, {-AISLE_WALL, 0, z}, {2 * AISLE_WALL, 0, 0}, {0, NAVE_HEIGHT + vaultRadius, 0});

    // A round window of dusk at the far end, in a stone ring.
    const glm::vec3 center(0, 6.1f, BACK + 0.02f);
    addSurface(scene, palette.window, {40, 1, true}, [&](float s, float t) {
        return center + t * 0.95f * glm::vec3(std::sin(2 * PI * s), std::cos(2 * PI * s), 0);
    });
    addSurface(scene, palette.stone, {40, 8, true}, [&](float s, float t) {
        const float r = 1.06f - 0.14f * std::cos(PI * t);
        return center + glm::vec3(r * std::sin(2 * PI * s), r * std::cos(2 * PI * s), 0.16f * std::sin(PI * t));
    });
}

// A saturated spotlight high on the opposite side of the nave, aimed at an arch's curtains.
void addSpot(Scene& scene, const Palette& palette, glm::vec3 position, glm::vec3 target, glm::vec3 color)
{
    PunctualLight light;
    light.name = "spot";
    light.kind = LightKind::Spot;
    light.intensity = color;
    light.position = position;
    light.direction = glm::normalize(target - position);
    light.innerConeAngle = glm::radians(14.0f);
    light.outerConeAngle = glm::radians(27.0f);
    scene.lights.push_back(light);
    // Its housing, behind the source.
    addBar(scene, palette.brass, position - 0.28f * light.direction, position - 0.02f * light.direction, 0.08f, 16);
}

} // namespace

Scene makeHall()
{
    Scene scene;
    scene.name = "hall";
    Palette palette;
    palette.stone = addMaterial(scene, diffuse("stone", {0.62f, 0.58f, 0.52f}));
    palette.plaster = addMaterial(scene, diffuse("plaster", {0.74f, 0.72f, 0.68f}));
    palette.darkTile = addMaterial(scene, glossy("dark tile", {0.09f, 0.085f, 0.08f}, 0.22f));
    palette.lightTile = addMaterial(scene, glossy("light tile", {0.52f, 0.49f, 0.45f}, 0.22f));
    palette.brass =
        addMaterial(scene, {.name = "brass", .baseColor = {0.78f, 0.57f, 0.28f, 1}, .metallic = 1, .roughness = 0.35f});
    palette.window = addMaterial(scene, emitter("dusk", {1.6f, 2.0f, 3.2f}));
    palette.cloths = {addMaterial(scene, diffuse("red cloth", {0.70f, 0.045f, 0.05f})),
                      addMaterial(scene, diffuse("blue cloth", {0.05f, 0.13f, 0.66f})),
                      addMaterial(scene, diffuse("green cloth", {0.06f, 0.48f, 0.13f})),
                      addMaterial(scene, diffuse("ochre cloth", {0.78f, 0.47f, 0.06f}))};
    const glm::vec3 colors[] = {{430, 26, 20}, {18, 60, 460}, {22, 300, 40}, {420, 200, 14}};

    addShell(scene, palette);
    for (const float sign : {-1.0f, 1.0f}) {
        for (int column = 0; column <= BAYS; ++column)
            addColumn(scene, palette, {sign * NAVE, 0, -BAY * static_cast<float>(column)});
        for (int bay = 0; bay < BAYS; ++bay) {
            addArch(scene, palette, sign, bay);
            const size_t tone = static_cast<size_t>(sign < 0 ? bay : bay + 2) % palette.cloths.size();
            const float z = bayCenter(bay), x = sign * (NAVE + 0.05f);
            addCurtain(scene, palette.cloths[tone], x, z - BAY / 2, 1);
            addCurtain(scene, palette.cloths[tone], x, z + BAY / 2, -1);
            addBar(scene, palette.brass, {x, SPRING - 0.02f, z + BAY / 2}, {x, SPRING - 0.02f, z - BAY / 2}, 0.025f);
            addSpot(scene, palette, {-sign * (NAVE - HALF_THICKNESS - 0.3f), 5.7f, z - 0.4f}, {x, 1.3f, z},
                    colors[tone]);
        }
    }
    scene.cameras.push_back(lookAt("nave", {-1.5, 1.65, 1.6}, {0.25, 2.75, -10}, 58.0));
    return scene;
}

} // namespace scene
