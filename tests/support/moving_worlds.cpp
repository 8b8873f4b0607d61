#include "tests/support/moving_worlds.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/scene/motion.h"
#include "engine/scene/shapes.h"
#include "tests/support/test_scenes.h"

namespace support
{

namespace
{

using glm::mat4, glm::vec3;
using scene::Material, scene::Scene;

constexpr glm::vec4 COPPER = {0.9f, 0.6f, 0.3f, 1};

Scene testScene(const char* name)
{
    const std::vector<TestScene> all = testScenes();
    return std::ranges::find(all, std::string(name), [](const TestScene& t) { return std::string(t.name); })->make();
}

// A scene that moves says so, and which of its materials change.
Scene moving(Scene scene, std::initializer_list<uint32_t> painted = {})
{
    const auto motion = std::make_shared<scene::Motion>();
    for (const uint32_t material : painted) motion->paints.push_back({.material = material});
    scene.motion = motion;
    return scene;
}

// The triangles of the last material but one: in ballOf() the ball, before the lamp.
std::pair<size_t, size_t> trianglesOf(const Scene& scene, size_t material)
{
    size_t first = scene.triangles.size(), end = 0;
    for (size_t t = 0; t < scene.triangles.size(); ++t) {
        if (scene.triangles[t].material != material) continue;
        first = std::min(first, t);
        end = t + 1;
    }
    return {first, end};
}
void moveMaterial(Scene& scene, size_t material, const mat4& place)
{
    const auto [first, end] = trianglesOf(scene, material);
    transform(scene, first, end, place);
}

constexpr size_t BALL = 1, LAMP = 2; // of ballOf()
const mat4 I(1);

// Rigid motion that goes on and on.
Scene ballRolls(uint32_t frame)
{
    Scene scene = moving(testScene("Glossy"));
    const float x = 0.12f * static_cast<float>(frame);
    const mat4 turn = glm::translate(glm::rotate(glm::translate(I, {0, 0.9f, 0}), -x, {0, 0, 1}), {0, -0.9f, 0});
    moveMaterial(scene, BALL, glm::translate(I, {-0.4f + x, 0, 0}) * turn);
    return scene;
}
// Two poses in turn: A B A B.
Scene ballJumps(uint32_t frame)
{
    Scene scene = moving(testScene("Glossy"));
    moveMaterial(scene, BALL, glm::translate(I, {frame % 2 ? 0.5f : -0.3f, 0, 0.2f}));
    return scene;
}
// Parked, and then gone to another place at once.
Scene ballParks(uint32_t frame)
{
    Scene scene = moving(testScene("Lambert"));
    moveMaterial(scene, BALL, glm::translate(I, {frame < 4 ? -0.5f : 0.5f, 0, 0}));
    return scene;
}
Scene ballVanishes(uint32_t frame)
{
    Scene scene = moving(testScene("Glossy"));
    const auto [first, end] = trianglesOf(scene, BALL);
    if (frame % 2 == 0) hide(scene, first, end);
    return scene;
}
Scene ballGrows(uint32_t frame)
{
    Scene scene = moving(testScene("Lambert"));
    const float size = 1 - 0.12f * static_cast<float>(frame % 5);
    moveMaterial(scene, BALL, glm::scale(glm::translate(I, {0, 0.9f * (1 - size), 0}), vec3(size)));
    return scene;
}
// A wall beside the ball, stretched to twice its length and back.
Scene wallStretches(uint32_t frame)
{
    Scene scene = testScene("Lambert");
    const uint32_t wall = scene::addMaterial(scene, scene::diffuse("wall", {0.3f, 0.7f, 0.8f}));
    scene::addQuad(scene, wall, {-1.2f, 0, -1.1f}, {frame % 2 ? 2.4f : 1.2f, 0, 0}, {0, 1.5f, 0});
    scene::addQuad(scene, wall, {1.1f, 0, -1}, {0, 0, 2}, {0, frame % 2 ? 0.9f : 1.8f, 0});
    return moving(std::move(scene));
}
// A mirrored instance that turns: its corners change places from frame to frame.
Scene ballMirrored(uint32_t frame)
{
    Scene scene = moving(testScene("Glossy"));
    const mat4 turned = glm::rotate(I, 0.2f * static_cast<float>(frame), {0, 1, 0});
    moveMaterial(scene, BALL, glm::scale(turned, {frame % 2 ? -1.0f : 1.0f, 1, 1}));
    return scene;
}
// Bodies stored once that roll, are mirrored in turn, come and go.
Scene copiesTurn(uint32_t frame)
{
    Scene scene = moving(testScene("Copies"));
    const double x = 0.1 * frame;
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        glm::dmat4& place = scene.instances[i].worldFromMesh;
        place = glm::rotate(glm::translate(place, {x, 0, 0}), 0.3 * x * double(i), glm::dvec3(0, 1, 0));
    }
    if (frame % 2) scene.instances[1].worldFromMesh = glm::scale(scene.instances[1].worldFromMesh, {-1, 1, 1});
    scene.instances[2].visible = frame % 3 != 1;
    return scene;
}
// Every vertex by itself, as skins and morph targets move them.
Scene ballWobbles(uint32_t frame)
{
    Scene scene = moving(testScene("Lambert"));
    const auto [first, end] = trianglesOf(scene, BALL);
    std::set<uint32_t> own;
    for (size_t t = first; t < end; ++t)
        own.insert(scene.triangles[t].vertices.begin(), scene.triangles[t].vertices.end());
    for (const uint32_t v : own) {
        vec3& p = scene.positions[v];
        p += scene.normals[v] * (0.12f * std::sin(5 * p.x + 3 * p.y + 0.9f * static_cast<float>(frame)));
    }
    return scene;
}
Scene lampMoves(uint32_t frame)
{
    Scene scene = moving(testScene("Lambert"));
    moveMaterial(scene, LAMP,
                 glm::translate(I, {0.25f * static_cast<float>(frame % 6) - 0.6f, -0.1f * float(frame % 3), 0}));
    return scene;
}
Scene lampChanges(uint32_t frame) // color and power, by a factor of 10 and to nothing
{
    Scene scene = moving(testScene("Glossy"), {LAMP});
    scene.environment = {};
    constexpr vec3 COLORS[] = {{6, 5, 4}, {0, 3, 12}, {60, 2, 0}, {0, 0, 0}, {1, 9, 2}};
    scene.materials[LAMP].emission = COLORS[frame % 5];
    const uint32_t wall = scene::addMaterial(scene, scene::emitter("glow", {0.3f, 0.2f, 0.1f}));
    scene::addQuad(scene, wall, {-1.5f, 0.1f, -1}, {0.5f, 0, 0.2f}, {0, 1.5f, 0});
    return scene;
}
Scene ceilingLit(uint32_t frame) // all light has come by way of a ceiling, from a spot that turns up and down
{
    Scene scene = testScene("Lambert");
    scene.environment = {};
    scene.materials[LAMP].emission = vec3(0);
    scene::addQuad(scene, scene::addMaterial(scene, scene::diffuse("ceiling", {0.8f, 0.9f, 0.7f})), {-2, 2.6f, -2},
                   {4, 0, 0}, {0, 0, 4});
    scene.lights.push_back({.kind = scene::LightKind::Spot,
                            .intensity = vec3(6, 4, 5) * (frame % 2 ? 1.0f : 4.0f),
                            .position = {0, 1.9f, 0},
                            .direction = {0, 1, 0},
                            .outerConeAngle = 1.2f});
    return moving(std::move(scene));
}
Scene lightsWander(uint32_t frame) // point, spot and directional
{
    Scene scene = moving(testScene("SeveralLights"));
    const float t = static_cast<float>(frame);
    scene.lights[0].position += vec3(0.2f * t, -0.1f * t, 0);
    scene.lights[0].intensity *= frame % 2 ? 2.0f : 0.1f;
    scene.lights[1].direction = glm::normalize(scene.lights[1].direction + vec3(0.2f * t, 0, 0.1f * t));
    if (frame % 3 == 1) scene.lights[2].intensity = vec3(0);
    return scene;
}
Scene paintDries(uint32_t frame) // base color, roughness, metal
{
    Scene scene = moving(testScene("Glossy"), {BALL});
    Material& ball = scene.materials[BALL];
    const float t = static_cast<float>(frame % 4) / 3;
    ball.baseColor = glm::mix(COPPER, glm::vec4(0.2f, 0.5f, 0.9f, 1), t);
    ball.roughness = 0.2f + 0.5f * t;
    ball.metallic = t;
    return scene;
}
Scene mirrorMoves(uint32_t frame)
{
    Scene scene = moving(testScene("Mirror"));
    moveMaterial(scene, BALL, glm::translate(I, {0.1f * static_cast<float>(frame) - 0.3f, 0, 0}));
    return scene;
}
Scene glassMoves(uint32_t frame)
{
    Scene scene = moving(testScene("FrostedGlass"));
    moveMaterial(scene, BALL, glm::translate(I, {0.1f * static_cast<float>(frame) - 0.3f, 0, 0}));
    return scene;
}
Scene panesSlide(uint32_t frame) // blended, before a wall
{
    Scene scene = moving(testScene("Panes"));
    for (size_t pane = 2; pane < 5; ++pane)
        moveMaterial(scene, pane, glm::translate(I, {0.1f * static_cast<float>(frame * (pane - 1)) - 0.3f, 0, 0}));
    return scene;
}
Scene bumpsMove(uint32_t frame) // textures go with what they are on
{
    Scene scene = moving(testScene("NormalMap"));
    moveMaterial(scene, 1,
                 glm::translate(I, {0.15f * static_cast<float>(frame) - 0.4f, 0.05f * static_cast<float>(frame), 0}));
    return scene;
}
Scene orthographicBall(uint32_t frame)
{
    Scene scene = moving(testScene("Orthographic"));
    moveMaterial(scene, BALL, glm::translate(I, {0.1f * static_cast<float>(frame) - 0.3f, 0, 0}));
    return scene;
}
Scene roomRebuilds(uint32_t frame) // a closed room whose light has passed all that moves: walls, the box, the lamp
{
    Scene scene = moving(testScene("Room"));
    const float t = static_cast<float>(frame);
    moveMaterial(scene, 0, glm::scale(I, {1 + 0.03f * t, 1, 1}));
    moveMaterial(scene, 1, glm::rotate(I, 0.15f * t, {0, 1, 0}));
    moveMaterial(scene, 2, glm::translate(I, {0.1f * t, 0, -0.1f * t}));
    return scene;
}

} // namespace

void transform(scene::Scene& scene, size_t firstTriangle, size_t endTriangle, const glm::mat4& place)
{
    const glm::mat3 normals = glm::inverseTranspose(glm::mat3(place));
    const bool mirrors = glm::determinant(glm::mat3(place)) < 0;
    std::set<uint32_t> own;
    for (size_t t = firstTriangle; t < endTriangle; ++t) {
        auto& vertices = scene.triangles[t].vertices;
        own.insert(vertices.begin(), vertices.end());
        if (mirrors) std::swap(vertices[1], vertices[2]);
    }
    for (const uint32_t v : own) {
        scene.positions[v] = glm::vec3(place * glm::vec4(scene.positions[v], 1));
        scene.normals[v] = glm::normalize(normals * scene.normals[v]);
        if (!scene.tangents.empty())
            scene.tangents[v] =
                glm::vec4(glm::normalize(glm::mat3(place) * glm::vec3(scene.tangents[v])), scene.tangents[v].w);
    }
}

void hide(scene::Scene& scene, size_t firstTriangle, size_t endTriangle)
{
    const uint32_t first = scene.triangles[firstTriangle].vertices[0];
    for (size_t t = firstTriangle; t < endTriangle; ++t) {
        for (const uint32_t v : scene.triangles[t].vertices) scene.positions[v] = glm::vec3(0);
        scene.triangles[t].vertices.fill(first);
    }
}

std::vector<MovingWorld> movingWorlds()
{
    return {
        {"BallRolls", ballRolls},
        {"BallJumps", ballJumps},
        {"BallParks", ballParks},
        {"BallVanishes", ballVanishes},
        {"BallGrows", ballGrows},
        {"WallStretches", wallStretches},
        {"BallMirrored", ballMirrored},
        {"BallWobbles", ballWobbles},
        {"CopiesTurn", copiesTurn},
        {"LampMoves", lampMoves},
        {"LampChanges", lampChanges},
        {"CeilingLit", ceilingLit},
        {"LightsWander", lightsWander, 2},
        {"PaintDries", paintDries},
        {"MirrorMoves", mirrorMoves},
        {"GlassMoves", glassMoves, 5},
        {"PanesSlide", panesSlide, 2},
        {"BumpsMove", bumpsMove, 2},
        {"OrthographicBall", orthographicBall, 2},
        {"RoomRebuilds", roomRebuilds, 8},
    };
}

} // namespace support
