// No closed body leaks: paths that are aimed at its edges and corners, from inside, meet all faces from inside. In
// Renderer's pictures a leak is light that passes through walls.
//
// TRICHROME_TEST_PATHS: how many paths a body, instead of the few of every day.

#include <bit>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/scene/shapes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/scene_buffers.h"

namespace
{

using glm::vec3, glm::dvec3;
using scene::Scene;

struct Path { // as closed_bodies_test.comp has it
    glm::vec4 origin, direction;
};

struct Body {
    const char* name;
    std::function<Scene()> make; // fronts inward
    std::vector<dvec3> within;   // paths begin there: where things are symmetric, and where they are not
};
void PrintTo(const Body& body, std::ostream* os)
{
    *os << body.name;
}

// Fronts of what `add` adds, turned inward.
Scene inwards(const std::function<void(Scene&)>& add)
{
    Scene scene;
    scene::addMaterial(scene, scene::diffuse("wall", vec3(0.5f)));
    add(scene);
    for (scene::Triangle& triangle : scene.triangles) std::swap(triangle.vertices[1], triangle.vertices[2]);
    return scene;
}

Scene box(const glm::mat4& transform)
{
    return inwards([&](Scene& scene) { scene::addBox(scene, 0, transform); });
}

glm::mat4 turned(float degrees, const vec3& size, const vec3& at = vec3(0))
{
    const glm::mat4 turn = glm::rotate(glm::translate(glm::mat4(1), at), glm::radians(degrees), {0.36f, 0.48f, 0.8f});
    return glm::scale(turn, size);
}

// A room with a corner that stands into it: walls that meet at 270 degrees.
Scene corner()
{
    return inwards([](Scene& scene) {
        const glm::vec2 plan[] = {{-1, -1}, {1, -1}, {1, 0}, {0, 0}, {0, 1}, {-1, 1}};
        const auto at = [&](size_t i, float y) { return vec3(plan[i % 6].x, y, plan[i % 6].y); };
        const auto triangle = [&](vec3 a, vec3 b, vec3 c) {
            const auto first = uint32_t(scene.positions.size());
            for (const vec3& p : {a, b, c}) {
                scene.positions.push_back(p);
                scene.normals.emplace_back(0, 1, 0);
            }
            scene.triangles.push_back({{first, first + 1, first + 2}, 0});
        };
        for (size_t i = 0; i < 6; ++i) {
            triangle(at(i, -1), at(i, 1), at(i + 1, 1));
            triangle(at(i, -1), at(i + 1, 1), at(i + 1, -1));
        }
        for (size_t i = 0; i < 6; ++i) { // fans around the corner that stands in
            if (i == 3 || i == 2) continue;
            triangle(at(3, 1), at(i + 1, 1), at(i, 1));
            triangle(at(3, -1), at(i, -1), at(i + 1, -1));
        }
    });
}

Scene tetrahedron()
{
    return inwards([](Scene& scene) {
        const vec3 p[] = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
        const uint32_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
        for (const auto& face : faces) {
            const auto first = uint32_t(scene.positions.size());
            for (const uint32_t v : face) {
                scene.positions.push_back(p[v]);
                scene.normals.emplace_back(0, 1, 0);
            }
            scene.triangles.push_back({{first, first + 1, first + 2}, 0});
        }
    });
}

// The box that `scene` is, in a scene of another scale: a triangle far away.
Scene besideFar(Scene scene, float distance)
{
    const auto first = uint32_t(scene.positions.size());
    for (const vec3& p : {vec3(0, distance, 0), {1, distance, 0}, {0, distance, 1}}) {
        scene.positions.push_back(p);
        scene.normals.emplace_back(0, 1, 0);
    }
    scene.triangles.push_back({{first, first + 1, first + 2}, 0});
    return scene;
}

const std::vector<dvec3> SYMMETRIC = {{0, 0, 0}, {0, 0, 0.5}, {0.25, 0.25, 0.25}, {0.3, -0.2, 0.11}};

const Body BODIES[] = {
    {"Box", [] { return box(glm::mat4(1)); }, SYMMETRIC},
    {"FlatBox",
     [] {
         return box(glm::scale(glm::mat4(1), {1, 0.01f, 1}));
     },
     {{0, 0, 0}, {0.5, 0.001, 0.3}}},
    {"TurnedBox", [] { return box(turned(33, vec3(1))); }, SYMMETRIC},
    {"TurnedFlatBox",
     [] {
         return box(turned(-71, {0.7f, 1, 0.02f}));
     },
     {{0, 0, 0}}},
    {"BoxOffTheOrigin",
     [] {
         return box(turned(20, vec3(0.02f), {1, -0.7f, 0.3f}));
     },
     {{1, -0.7, 0.3}}},
    {"BoxBesideAFarTriangle", [] { return besideFar(box(turned(0, vec3(1))), 4e4f); }, SYMMETRIC},
    {"TurnedBoxBesideAFarTriangle", [] { return besideFar(box(turned(33, vec3(1))), 4e4f); }, SYMMETRIC},
    {"Corner", corner, {{-0.5, 0, -0.5}, {-0.5, 0.5, 0.5}, {0.4, 0.1, -0.3}}},
    {"Tetrahedron", tetrahedron, {{0, 0, 0}, {0.1, 0.2, -0.1}}},
    {"Sphere", [] { return inwards([](Scene& s) { scene::addSphere(s, 0, vec3(0), 1, 3); }); }, SYMMETRIC},
};

class ClosedBodies : public GpuTest, public testing::WithParamInterface<Body>
{
};

TEST_P(ClosedBodies, LeakNowhere)
{
    if (isSlow(device())) GTEST_SKIP() << "SKIPPED ON SwiftShader: too slow for so many rays";
    const Body& body = GetParam();
    const Scene scene = body.make();
    const support::SceneBuffers buffers(device(), scene);
    const double scale = buffers.tables().lengthScale;
    const char* asked = std::getenv("TRICHROME_TEST_PATHS");
    const uint64_t count = asked != nullptr ? uint64_t(std::strtod(asked, nullptr)) : 200'000;
    constexpr uint64_t BATCH = 1 << 20;

    std::mt19937_64 random(7);
    const auto uniform = [&] { return double(random() >> 11) * 0x1p-53; };
    const auto target = [&] { // a corner, a point of an edge, or near one, by more or less
        const auto& v = scene.triangles[random() % scene.triangles.size()].vertices;
        const dvec3 a = scene.positions[v[random() % 3]], b = scene.positions[v[random() % 3]];
        const uint64_t kind = random() % 8;
        const double along = kind == 0 ? 0 : kind < 3 ? 0.5 : uniform();
        const dvec3 off = dvec3(uniform(), uniform(), uniform()) - 0.5;
        return glm::mix(a, b, along) + (kind < 5 ? 0.0 : std::pow(10.0, -8 * uniform())) * off;
    };
    for (uint64_t done = 0; done < count; done += BATCH) {
        std::vector<Path> paths(std::min(BATCH, count - done));
        for (Path& path : paths) {
            const dvec3 from = body.within[random() % body.within.size()] * scale;
            const dvec3 direction = glm::normalize(target() * scale - from);
            path = {glm::vec4(from, 0), glm::vec4(direction, std::bit_cast<float>(uint32_t(random() >> 34)))};
        }
        const gpu::Buffer pathBuffer = upload("paths", paths), leakBuffer = create<uint32_t>("leaks", 36);
        run({.shader = TEST_SPIRV_DIR "/closed_bodies_test",
             .buffers = buffers.with({{"Paths", &pathBuffer}, {"Leaks", &leakBuffer}}),
             .threads = {uint32_t(paths.size())}});
        const std::vector<uint32_t> leaks = download<uint32_t>(leakBuffer);
        ASSERT_EQ(leaks[0], 0u) << "of " << paths.size() << " paths; path " << leaks[4] << ", bounce " << leaks[5]
                                << ", from triangle " << int(leaks[6]) << " to " << int(leaks[7]);
    }
}

INSTANTIATE_TEST_SUITE_P(All, ClosedBodies, testing::ValuesIn(BODIES),
                         [](const auto& body) { return std::string(body.param.name); });

} // namespace
