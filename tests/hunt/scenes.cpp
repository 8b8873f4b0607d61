// The scenes of each kind.

#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/base/check.h"
#include "engine/scene/shapes.h"
#include "tests/hunt/case.h"

namespace hunt
{

namespace
{

using glm::vec3, glm::dvec3;
using scene::Scene;

constexpr double PI = std::numbers::pi;

struct Builder {
    Truth truth;
    const Palette& palette;
    Draw& draw;
    Scene scene = {};

    uint32_t material(Stuff stuff) { return scene::addMaterial(scene, palette.material(draw, stuff)); }
    uint32_t wall() { return material(palette.anyOpaque(draw)); }
    bool exact() const { return truth == Truth::Reference; }

    void quad(uint32_t material, vec3 corner, vec3 u, vec3 v) { scene::addQuad(scene, material, corner, u, v); }
    void triangle(uint32_t material, vec3 a, vec3 b, vec3 c);
    void box(uint32_t material, vec3 center, vec3 half, bool turned);
    void sky(uint32_t mostRows);
    void lamp(vec3 at, double size, double radiance, vec3 towards);
    void lights(vec3 center, double size, bool extreme);
    void look(dvec3 from, dvec3 at, double degrees)
    {
        scene.cameras.push_back(scene::lookAt("camera", from, at, degrees));
    }
    bool solid(Stuff stuff) const { return stuff == Stuff::SolidClear || stuff == Stuff::SolidRough; }
};

void Builder::triangle(uint32_t material, vec3 a, vec3 b, vec3 c)
{
    const uint32_t first = uint32_t(scene.positions.size());
    const vec3 normal = glm::normalize(cross(b - a, c - a));
    for (const vec3& p : {a, b, c}) {
        scene.positions.push_back(p);
        scene.normals.push_back(normal);
    }
    scene.triangles.push_back({.vertices = {first, first + 1, first + 2}, .material = material});
}

void Builder::box(uint32_t material, vec3 center, vec3 half, bool turned)
{
    glm::mat4 place = glm::translate(glm::mat4(1), center);
    if (turned) place = glm::rotate(place, float(draw.between(0, 2 * PI)), draw.direction());
    scene::addBox(scene, material, glm::scale(place, half));
}

void Builder::sky(uint32_t mostRows)
{
    const uint32_t rows = uint32_t(draw.logBetween(4, mostRows + 0.5)), columns = draw.of({1u, 4u, 4u, 8u, 13u});
    const vec3 ground = draw.chance(0.4) ? vec3(0) : draw.color(0.01, 1);
    scene.environment = {columns, rows, std::vector<vec3>(size_t{columns} * rows, ground)};
    const bool patchy = draw.chance(0.3);
    if (patchy && rows < 64)
        for (vec3& texel : scene.environment.radiance) texel = draw.color(0, 1);
    const uint32_t spots = ground == vec3(0) || draw.chance(0.7) ? draw.from(1, 3) : 0;
    for (uint32_t i = 0; i < spots; ++i) {
        const uint32_t height = draw.chance(0.6) ? 1 : draw.from(1, std::max(1u, rows / 16)),
                       column = draw.below(columns);
        const uint32_t first = draw.below(draw.chance(0.8) ? (rows + 1) / 2 : rows); // above the horizon, mostly
        const vec3 radiance = draw.color(0.2, 1) * float(draw.logBetween(1, 1e6));
        for (uint32_t row = first; row < std::min(rows, first + height); ++row)
            scene.environment.radiance[row * columns + column] = radiance;
    }
}

// A square that faces `towards`.
void Builder::lamp(vec3 at, double size, double radiance, vec3 towards)
{
    const vec3 n = glm::normalize(towards - at);
    const vec3 u = glm::normalize(cross(std::abs(n.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0), n)) * float(size);
    const vec3 v = cross(n, u);
    quad(scene::addMaterial(scene, palette.lamp(draw, radiance)), at - 0.5f * (u + v), u, v);
}

// A light of each kind that the palette has, around a place of some size.
void Builder::lights(vec3 center, double size, bool extreme)
{
    const auto around = [&](double low, double high) {
        vec3 d = draw.direction();
        d.y = std::abs(d.y) * 0.8f + 0.2f;
        return center + float(size * draw.between(low, high)) * glm::normalize(d);
    };
    if (palette.emitters)
        for (uint32_t i = draw.from(1, extreme ? 3 : 2); i > 0; --i) {
            const double edge = size * (extreme ? draw.logBetween(1e-3, 2) : draw.between(0.2, 0.8));
            lamp(around(0.7, 1.2), edge, (extreme ? draw.logBetween(1e-3, 1e3) : draw.logBetween(0.5, 10)), center);
        }
    if (palette.punctual)
        for (uint32_t i = draw.from(1, 2); i > 0; --i) {
            scene::PunctualLight light;
            light.intensity = draw.color(0.2, 1) *
                              float(size * size * (extreme ? draw.logBetween(1e-3, 1e4) : draw.logBetween(1, 20)));
            light.position = around(0.7, 1.2);
            if (draw.chance(0.5)) {
                light.kind = scene::LightKind::Spot;
                light.direction = glm::normalize(center + float(0.2 * size) * draw.direction() - light.position);
                const double degrees = extreme ? draw.logBetween(0.06, 80) : draw.between(10, 70);
                light.outerConeAngle = float(degrees * PI / 180);
                light.innerConeAngle =
                    (light.outerConeAngle - 1e-4f) * (draw.chance(0.5) ? 0 : float(draw.between(0, 0.95)));
            }
            scene.lights.push_back(light);
        }
    if (palette.directional)
        for (uint32_t i = draw.from(1, 2); i > 0; --i) {
            scene::PunctualLight light{.kind = scene::LightKind::Directional};
            light.intensity =
                draw.color(0.2, 1) * float(extreme ? draw.logBetween(1e-3, 1e4) : draw.logBetween(0.5, 5));
            light.direction =
                glm::normalize(vec3(0, -0.3, 0) -
                               glm::abs(draw.direction()) * vec3(draw.of({-1.0f, 1.0f}), 1, draw.of({-1.0f, 1.0f})));
            scene.lights.push_back(light);
        }
    if (palette.sky && scene.environment.width == 0) sky(extreme && draw.chance(0.3) ? 512 : 8);
}

void panes(Builder& b)
{
    Draw& draw = b.draw;
    const double distance = draw.logBetween(0.5, 8), spacing = draw.logBetween(0.005, 0.5);
    const uint32_t count = draw.from(1, 5);
    const float extent = float(draw.between(2, 6) * (distance + count * spacing)), depth = float(distance);
    const auto across = [&](uint32_t material, float z, float size) {
        const vec3 tilt(0, 0, draw.chance(0.2) ? draw.between(-0.3, 0.3) * spacing : 0);
        b.quad(material, vec3(-size / 2, -size / 2, -z), vec3(size, 0, 0) + tilt, {0, size, 0});
    };
    for (uint32_t i = 0; i < count; ++i) {
        const Stuff stuff = draw.chance(0.7) && b.palette.has(Stuff::Blend) ? Stuff::Blend : b.palette.any(draw);
        const float z = depth + float(i * spacing);
        const bool part =
            draw.chance(0.3) || stuff == Stuff::Diffuse || stuff == Stuff::Glossy || stuff == Stuff::RoughMetal;
        const float size = part ? extent * float(draw.between(0.1, 0.5)) : extent;
        if (b.solid(stuff))
            b.box(b.material(stuff), {0, 0, -z}, {size / 2, size / 2, float(spacing * draw.between(0.05, 0.4))}, false);
        else
            across(b.material(stuff), z, size);
    }
    across(b.wall(), depth + float(count * spacing), 2 * extent);
    const vec3 eye = draw.chance(0.5) ? vec3(0) : vec3(draw.between(-0.5, 0.5), draw.between(-0.5, 0.5), 0) * depth;
    if (b.palette.sky && draw.chance(0.5)) {
        const vec3 light = draw.chance(0.5) ? vec3(1) : draw.color(0.1, 1);
        b.scene.environment = {1, 1, {light}};
    }
    b.lights({0, 0, -0.3f * depth}, 0.4 * distance, false);
    b.look(eye, {0, 0, -depth}, draw.between(20, 60));
}

void sky(Builder& b)
{
    Draw& draw = b.draw;
    b.sky(4096);
    b.quad(b.wall(), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
    if (draw.chance(0.5))
        b.box(b.material(b.palette.any(draw)), {draw.between(-0.5, 0.5), 0.8, 0}, draw.point(0.2, 0.6), true);
    if (draw.chance(0.3)) scene::addSphere(b.scene, b.material(b.palette.any(draw)), {0.7, 0.7, 0.4}, 0.4f, 0);
    b.lights({0, 0.5, 0}, 2, false);
    b.look({draw.between(-1, 1), draw.between(1, 3), 3}, {0, draw.between(0, 0.5), 0}, draw.between(25, 60));
}

// A corner, a lamp, some things of the size, one of them thin.
void smallWorld(Builder& b, float size)
{
    Draw& draw = b.draw;
    if (draw.chance(0.7)) {
        const vec3 half = vec3(draw.between(0.4, 0.8), 0.4, draw.between(0.4, 0.8)) * size;
        scene::addBox(b.scene, b.wall(),
                      glm::scale(glm::translate(glm::mat4(1), {0, half.y, 0}), half)); // inside is seen
    } else {
        b.quad(b.wall(), vec3(-1, 0, 1) * size, vec3(2, 0, 0) * size, vec3(0, 0, -2) * size);
    }
    for (uint32_t i = draw.from(0, 2); i > 0; --i) {
        const vec3 center = vec3(draw.between(-0.25, 0.25), draw.between(0.15, 0.4), draw.between(-0.25, 0.1)) * size;
        const Stuff stuff = b.palette.any(draw);
        if (draw.chance(0.5)) {
            const vec3 thin =
                vec3(draw.between(0.08, 0.15), draw.between(0.08, 0.14), draw.logBetween(2e-3, 0.05)) * size;
            b.box(b.material(stuff), center, thin, draw.chance(0.7));
        } else {
            b.box(b.material(stuff), center, vec3(0.1f * size), true);
        }
    }
    if (b.palette.emitters)
        b.lamp(vec3(0, 0.78, 0) * size, draw.between(0.1, 0.3) * size, draw.logBetween(1, 10), vec3(0));
    if (b.palette.punctual)
        b.scene.lights.push_back({.intensity = draw.color() * (size * size), .position = vec3(0.1, 0.6, 0.1) * size});
    if (b.palette.directional)
        b.scene.lights.push_back(
            {.kind = scene::LightKind::Directional, .direction = glm::normalize(vec3(0.2, -1, -0.3))});
    if (b.palette.sky) b.sky(8);
    b.look(dvec3(draw.between(-0.2, 0.2), draw.between(0.3, 0.6), 0.38) * double(size),
           dvec3(0, draw.between(0.1, 0.3), -0.1) * double(size), draw.between(40, 70));
}

void scales(Builder& b)
{
    Draw& draw = b.draw;
    const double far = draw.logBetween(100, 4e4);
    // What is compared with float64 keeps the small world where float32 numbers are fine, and so does, less strictly,
    // what lies beside a triangle on one side alone: the numbers' origin is in the middle of all.
    const uint32_t shape = draw.below(b.exact() ? 3 : 4);
    const float size = float(draw.logBetween(b.exact() ? 0.5 : shape == 3 ? std::max(0.01, 1e-5 * far) : 0.01, 5));
    smallWorld(b, size);
    const vec3 spread(far, far, far);
    switch (shape) {
    case 0:
        scene::addSphere(b.scene, b.wall(), vec3(0), float(far), 1, scene::Normals::Smooth, scene::Facing::Inward);
        break;
    case 1:
        b.quad(b.wall(), vec3(-1, 0, 1) * spread + vec3(0, -draw.between(0.05, 0.5) * size, 0), vec3(2, 0, 0) * spread,
               vec3(0, 0, -2) * spread);
        break;
    case 2:
        for (const float side : {-1.0f, 1.0f})
            b.triangle(b.wall(), vec3(side, 0.1, 0) * spread, vec3(side, 0.1, 0.01) * spread,
                       vec3(side, 0.12, 0) * spread);
        break;
    default: b.triangle(b.wall(), vec3(0.1, 0, 1) * spread, vec3(0, 0, 1) * spread, vec3(0, 0.1, 1) * spread); break;
    }
}

void sealed(Builder& b)
{
    Draw& draw = b.draw;
    const float size = float(draw.chance(0.7) ? 1 : draw.logBetween(1e-3, 1e3));
    const bool symmetric = draw.chance(0.6);
    const vec3 half = symmetric ? vec3(size) : draw.point(0.3, 1.5) * size;
    switch (draw.below(4)) {
    case 0:
        scene::addSphere(b.scene, b.wall(), vec3(0), size, draw.below(2),
                         draw.of({scene::Normals::Smooth, scene::Normals::Flat}),
                         draw.of({scene::Facing::Inward, scene::Facing::Outward}));
        break;
    case 1: b.box(b.wall(), vec3(0), half, true); break;
    default: b.box(b.wall(), vec3(0), half, false); break;
    }
    if (draw.chance(0.4)) b.box(b.wall(), vec3(0, -0.4, -0.3) * half, vec3(0.2f, 0.2f, 0.2f) * half, !symmetric);
    const float out = 8 * size;
    if (b.palette.emitters)
        for (uint32_t i = draw.from(1, 3); i > 0; --i)
            b.lamp(out * draw.direction(), 0.7 * double(out), draw.logBetween(1, 1e4), vec3(0));
    if (b.palette.punctual)
        b.scene.lights.push_back(
            {.intensity = vec3(float(draw.logBetween(1, 1e4)) * size * size), .position = out * draw.direction()});
    if (b.palette.directional)
        b.scene.lights.push_back(
            {.kind = scene::LightKind::Directional, .intensity = vec3(1e3f), .direction = draw.direction()});
    if (b.palette.sky) b.scene.environment = {1, 1, {draw.color() * float(draw.logBetween(1, 1e4))}};
    const dvec3 eye =
        symmetric ? dvec3(0, 0, draw.of({0.0, 0.0, 0.25, 0.5}) * double(size)) : dvec3(draw.point(-0.25, 0.25) * size);
    // A hundredth of the size ahead: a camera that goes round it and a parallel one's picture stay inside.
    const dvec3 ahead = 0.01 * double(size) * (symmetric ? dvec3(0, 0, -1) : dvec3(draw.direction()));
    b.look(eye, eye + ahead, symmetric ? draw.of({45.0, 60.0, 90.0, 90.0, 120.0}) : draw.between(30, 120));
}

void edges(Builder& b)
{
    Draw& draw = b.draw;
    const uint32_t count = draw.from(1, 3);
    for (uint32_t i = 0; i < count; ++i) {
        const float z = -1 - float(i) * draw.of({0.25f, 0.5f, 1.0f}), s = draw.of({0.5f, 1.0f, 2.0f});
        const Stuff stuff = draw.chance(0.6) && b.palette.has(Stuff::Blend) ? Stuff::Blend : b.palette.any(draw);
        if (b.solid(stuff) || draw.chance(0.15))
            b.box(b.material(stuff), {0, 0, z}, {s / 2, s / 2, 0.0625}, false);
        else
            b.quad(b.material(stuff), {-s, -s, z}, {2 * s, 0, 0}, {0, 2 * s, 0});
    }
    b.quad(b.wall(), {-16, -16, -4}, {32, 0, 0}, {0, 32, 0});
    b.lights({0, 0, -1}, 2, false);
    b.look({0, 0, draw.of({0.0, 0.5, 1.0})}, {0, 0, -1}, draw.of({45.0, 60.0, 90.0}));
}

void someThings(Builder& b, uint32_t most)
{
    Draw& draw = b.draw;
    for (uint32_t i = draw.from(1, most); i > 0; --i) {
        const vec3 center(draw.between(-1, 1), draw.between(0.3, 1.5), draw.between(-1, 0.8));
        const float size = float(draw.logBetween(0.1, 0.7));
        const Stuff stuff = b.palette.any(draw);
        const uint32_t material = b.material(stuff);
        switch (b.solid(stuff) ? draw.below(2) : draw.below(4)) {
        case 0: b.box(material, center, draw.point(0.3, 1) * size, true); break;
        case 1:
            scene::addSphere(b.scene, material, center, size, 0,
                             draw.of({scene::Normals::Smooth, scene::Normals::Flat}));
            break;
        case 2: b.quad(material, center, size * draw.direction(), size * draw.direction()); break;
        default:
            b.triangle(material, center, center + size * draw.direction(), center + size * draw.direction());
            break;
        }
    }
}

void things(Builder& b)
{
    Draw& draw = b.draw;
    if (draw.chance(0.3))
        scene::addBox(b.scene, b.wall(), {-2, 0, -2}, {2, 2.8, 4});
    else
        b.quad(b.wall(), {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    someThings(b, 5);
    b.lights({0, 0.8, 0}, 1.5, false);
    b.look({draw.between(-1.5, 1.5), draw.between(0.5, 2.2), 3.4}, {0, 0.8, 0}, draw.between(25, 50));
}

void room(Builder& b)
{
    Draw& draw = b.draw;
    scene::addBox(b.scene, b.wall(), {-2, 0, -2}, {2, 2.8, 4});
    someThings(b, 3);
    b.lamp({draw.between(-1, 1), 2.7, draw.between(-1, 1)}, draw.between(0.4, 1.5), draw.logBetween(1, 10), {0, 0, 0});
    b.lights({0, 0.8, 0}, 1.2, false);
    b.look({draw.between(-1.5, 1.5), draw.between(0.5, 2.2), 3.4}, {0, 0.8, 0}, draw.between(25, 50));
}

void lights(Builder& b)
{
    Draw& draw = b.draw;
    b.quad(b.wall(), {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    someThings(b, 2);
    b.lights({0, 0.5, 0}, 2, true);
    b.look({draw.between(-1.5, 1.5), draw.between(0.5, 2.2), 3.4}, {0, 0.4, 0}, draw.between(25, 50));
}

} // namespace

Scene drawScene(Kind kind, Truth truth, const Palette& palette, Draw& draw)
{
    Builder b{truth, palette, draw};
    switch (kind) {
    case Kind::Panes: panes(b); break;
    case Kind::Sky: sky(b); break;
    case Kind::Scales: scales(b); break;
    case Kind::Sealed: sealed(b); break;
    case Kind::Edges: edges(b); break;
    case Kind::Lights: lights(b); break;
    case Kind::Things:
    case Kind::Colors: things(b); break;
    case Kind::Moving: room(b); break;
    }
    return std::move(b.scene);
}

} // namespace hunt
