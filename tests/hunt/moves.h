#pragma once
// What moves in a case, and where it is in each frame.

#include <cstdint>
#include <vector>

#include "engine/scene/scene.h"
#include "tests/hunt/draw.h"

namespace hunt
{

// Between the scene at rest (amount 0) and another state of one thing in it (amount 1).
struct Move {
    enum class What : uint32_t {
        Place,  // the triangles of a material, carried: stretched, turned, and slid
        Wobble, // each of their vertices by itself
        Hide,   // all of them
        Paint,  // the material
        Light   // of Scene::lights
    };
    enum class When : uint32_t {
        Steady, // back to amount 0 within six frames, and again
        InTurn, // 0 1 0 1
        Until,  // 1, then 0 for so many frames
        Once    // 1 so many frames ago
    };
    What what = What::Place;
    When when = When::InTurn;
    uint32_t frames = 1;   // Until, Once
    bool reversed = false; // 1 - amount
    uint32_t target = 0;   // of Scene::materials, or Scene::lights

    glm::vec3 center = {0, 0, 0}; // fixed, but for `slide`
    glm::vec3 slide = {0, 0, 0};  // Wobble: by this times a sine
    glm::vec3 turn = {0, 0, 0};   // axis times angle. Wobble: of its waves, radians a meter
    glm::vec3 stretch = {1, 1, 1};
    glm::vec4 color = {1, 1, 1, 1}; // base color; Light: factor of its intensity
    glm::vec3 emission = {0, 0, 0};
    float roughness = 1, metallic = 0;

    bool movesTriangles() const { return what == What::Place || what == What::Wobble || what == What::Hide; }
    // `framesAgo`: before the last one, so that a shorter history ends with the same scene.
    float amount(uint32_t framesAgo) const;
    bool operator==(const Move&) const = default;
};
constexpr const char* WHAT_NAMES[] = {"place", "wobble", "hide", "paint", "light"};
constexpr const char* WHEN_NAMES[] = {"steady", "in turn", "until", "once"};

// In a history of so many frames. `paints`: some do, the first one surely; otherwise none.
std::vector<Move> drawMoves(Draw& draw, const scene::Scene& scene, uint32_t frames, bool paints);

// The scene with a motion that names the materials which change, as a renderer has to know before.
scene::Scene withMotion(scene::Scene scene, const std::vector<Move>& moves);
scene::Scene posed(scene::Scene scene, const std::vector<Move>& moves, uint32_t framesAgo);

} // namespace hunt
