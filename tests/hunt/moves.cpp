#include "tests/hunt/moves.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/scene/motion.h"
#include "tests/support/moving_worlds.h"

namespace hunt
{

using glm::mat4, glm::vec3, glm::vec4;
using scene::Material, scene::PunctualLight, scene::Scene;

namespace
{

mat4 turned(const mat4& place, const vec3& turn)
{
    const float angle = glm::length(turn);
    return angle > 0 ? glm::rotate(place, angle, turn / angle) : place;
}

mat4 placeOf(const Move& move, float amount)
{
    const mat4 place = turned(glm::translate(mat4(1), move.center + amount * move.slide), amount * move.turn);
    vec3 stretch = glm::pow(glm::abs(move.stretch), vec3(amount));
    if (amount > 0.5f) stretch *= glm::sign(move.stretch); // a mirror has no half
    return glm::translate(glm::scale(place, stretch), -move.center);
}

void wobble(Scene& scene, size_t first, size_t end, const Move& move, float amount)
{
    std::set<uint32_t> own;
    for (size_t t = first; t < end; ++t)
        own.insert(scene.triangles[t].vertices.begin(), scene.triangles[t].vertices.end());
    for (const uint32_t v : own) {
        vec3& p = scene.positions[v];
        p += amount * std::sin(glm::dot(move.turn, p - move.center) + 1) * move.slide;
    }
}

// Triangles of one material follow each other.
void moveTriangles(Scene& scene, const Move& move, float amount)
{
    const auto isOf = [&](const scene::Triangle& t) { return t.material == move.target; };
    const auto begin = std::ranges::find_if(scene.triangles, isOf);
    const size_t first = size_t(begin - scene.triangles.begin());
    const size_t end = first + size_t(std::find_if_not(begin, scene.triangles.end(), isOf) - begin);
    if (first == end) return;
    switch (move.what) {
    case Move::What::Place: support::transform(scene, first, end, placeOf(move, amount)); break;
    case Move::What::Wobble: wobble(scene, first, end, move, amount); break;
    default: support::hide(scene, first, end); break;
    }
}

void paint(Material& material, const Move& move, float amount)
{
    material.baseColor = glm::mix(material.baseColor, move.color, amount);
    material.emission = glm::mix(material.emission, move.emission, amount);
    material.roughness = glm::mix(material.roughness, move.roughness, amount);
    material.metallic = glm::mix(material.metallic, move.metallic, amount);
}

void moveLight(PunctualLight& light, const Move& move, float amount)
{
    light.position += amount * move.slide;
    light.direction = glm::normalize(vec3(turned(mat4(1), amount * move.turn) * vec4(light.direction, 0)));
    light.intensity *= glm::mix(vec3(1), vec3(move.color), amount);
}

// What has one material.
struct Group {
    uint32_t material = 0;
    vec3 low = vec3(INFINITY), high = vec3(-INFINITY);
    bool emits = false;
};

std::vector<Group> groupsOf(const Scene& scene)
{
    std::vector<Group> groups;
    for (uint32_t m = 0; m < scene.materials.size(); ++m) {
        Group group{.material = m, .emits = scene.materials[m].emission != vec3(0)};
        for (const scene::Triangle& triangle : scene.triangles)
            if (triangle.material == m)
                for (const uint32_t v : triangle.vertices) {
                    group.low = glm::min(group.low, scene.positions[v]);
                    group.high = glm::max(group.high, scene.positions[v]);
                }
        if (glm::distance(group.low, group.high) > 0 && group.low.x <= group.high.x) groups.push_back(group);
    }
    return groups;
}

vec3 drawTurn(Draw& draw)
{
    const double most = draw.chance(0.4) ? 0.3 : std::numbers::pi;
    return draw.direction() * float(draw.between(0.02, most));
}

class Drawing
{
  public:
    Drawing(Draw& draw, const Scene& scene, uint32_t frames)
        : draw_(draw), scene_(scene), frames_(frames), groups_(groupsOf(scene)),
          distance_(float(glm::length(scene.cameras.at(0).target - scene.cameras.at(0).position)))
    {
    }

    Move light()
    {
        Move move = timed(Move::What::Light);
        move.target = draw_.below(uint32_t(scene_.lights.size()));
        if (draw_.chance(0.6)) move.slide = float(draw_.logBetween(0.02, 1)) * distance_ * draw_.direction();
        if (draw_.chance(0.4)) move.turn = drawTurn(draw_);
        if (draw_.chance(0.7)) move.color = vec4(change(), 1);
        return move;
    }

    Move paint()
    {
        const Group group = any(0.75);
        const Material& own = scene_.materials[group.material];
        Move move = timed(Move::What::Paint);
        move.target = group.material;
        move.color = own.baseColor;
        move.emission = own.emission;
        move.roughness = own.roughness;
        move.metallic = own.metallic;
        if (draw_.chance(0.5)) move.color = vec4(draw_.color(), own.baseColor.a);
        if (own.alpha == scene::Alpha::Blend && draw_.chance(0.5)) move.color.a = float(draw_.between(0.1, 0.9));
        if (draw_.chance(0.4)) move.roughness = draw_.chance(0.1) ? 0 : float(draw_.logBetween(0.05, 1));
        if (draw_.chance(0.3)) move.metallic = draw_.chance(0.5) ? 1 - own.metallic : float(draw_.uniform());
        if (group.emits && draw_.chance(0.8))
            move.emission *= change();
        else if (!own.unlit && draw_.chance(0.2))
            move.emission = draw_.color(0, 1) * float(draw_.logBetween(0.1, 5));
        return move;
    }

    Move triangles()
    {
        const double choice = draw_.uniform();
        Move move = timed(choice < 0.65 ? Move::What::Place : choice < 0.8 ? Move::What::Wobble : Move::What::Hide);
        const Group group = any(0.3);
        move.target = group.material;
        move.center = 0.5f * (group.low + group.high);
        const float size = glm::distance(group.low, group.high), reach = std::min(size, distance_);
        if (move.what == Move::What::Wobble) {
            move.slide = float(draw_.logBetween(0.02, 0.3)) * reach * draw_.direction();
            move.turn = float(draw_.logBetween(1, 20)) / size * draw_.direction();
        } else if (move.what == Move::What::Place) {
            place(move, reach);
        }
        return move;
    }

  private:
    Move timed(Move::What what)
    {
        using enum Move::When;
        return {.what = what,
                .when = draw_.of({Steady, InTurn, InTurn, Until, Once}),
                .frames = draw_.chance(0.5) ? 1 : draw_.from(1, std::max(frames_ - 1, 1u)),
                .reversed = draw_.chance(0.4)};
    }

    // Of a light: out, or another color and power.
    vec3 change() { return draw_.chance(0.3) ? vec3(0) : draw_.color(0, 1) * float(draw_.logBetween(0.05, 20)); }

    Group any(double shines)
    {
        std::vector<Group> lamps;
        std::ranges::copy_if(groups_, std::back_inserter(lamps), &Group::emits);
        const std::vector<Group>& from = !lamps.empty() && draw_.chance(shines) ? lamps : groups_;
        return from[draw_.below(uint32_t(from.size()))];
    }

    void place(Move& move, float reach)
    {
        if (draw_.chance(0.4)) move.turn = drawTurn(draw_);
        if (draw_.chance(0.5)) {
            const auto factor = [&] { return float(draw_.logBetween(0.2, 5)); };
            move.stretch = vec3(factor());
            if (draw_.chance(0.7)) move.stretch.y = factor(), move.stretch.z = factor();
            if (draw_.chance(0.25)) move.stretch[int(draw_.below(3))] *= -1;
        }
        const bool rests = move.turn == vec3(0) && move.stretch == vec3(1);
        if (rests || draw_.chance(0.6)) move.slide = float(draw_.logBetween(0.01, 1.5)) * reach * draw_.direction();
    }

    Draw& draw_;
    const Scene& scene_;
    uint32_t frames_;
    std::vector<Group> groups_;
    float distance_; // of what the camera looks at
};

} // namespace

float Move::amount(uint32_t framesAgo) const
{
    float amount = 0;
    switch (when) {
    case When::Steady: amount = float(framesAgo % 6) / 5; break;
    case When::InTurn: amount = float(framesAgo % 2); break;
    case When::Until: amount = framesAgo >= frames ? 1 : 0; break;
    case When::Once: amount = framesAgo == frames ? 1 : 0; break;
    }
    return reversed ? 1 - amount : amount;
}

std::vector<Move> drawMoves(Draw& draw, const Scene& scene, uint32_t frames, bool paints)
{
    Drawing drawing(draw, scene, frames);
    std::vector<Move> moves;
    for (uint32_t count = draw.from(1, 3); moves.size() < count;)
        moves.push_back(paints && (moves.empty() || draw.chance(0.3)) ? drawing.paint()
                        : !scene.lights.empty() && draw.chance(0.4)   ? drawing.light()
                                                                      : drawing.triangles());
    return moves;
}

// What may be painted is compiled in: all materials, so that cases of a session share it.
Scene withMotion(Scene scene, const std::vector<Move>& moves)
{
    const auto motion = std::make_shared<scene::Motion>();
    if (std::ranges::find(moves, Move::What::Paint, &Move::what) != moves.end())
        for (uint32_t m = 0; m < scene.materials.size(); ++m) motion->paints.push_back({.material = m});
    scene.motion = motion;
    return scene;
}

Scene posed(Scene scene, const std::vector<Move>& moves, uint32_t framesAgo)
{
    for (const Move& move : moves) {
        const float amount = move.amount(framesAgo);
        if (amount == 0) continue;
        if (move.movesTriangles())
            moveTriangles(scene, move, amount);
        else if (move.what == Move::What::Paint)
            paint(scene.materials.at(move.target), move, amount);
        else
            moveLight(scene.lights.at(move.target), move, amount);
    }
    return scene;
}

} // namespace hunt
