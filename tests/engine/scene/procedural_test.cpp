// Covers engine/scene/procedural_dim.cpp, engine/scene/procedural_hall.cpp, engine/scene/procedural_lamps.cpp.

#include "engine/scene/procedural.h"

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <set>
#include <string>
#include <tuple>

namespace scene
{
namespace
{

glm::dvec3 areaNormal(const Scene& scene, const Triangle& triangle)
{
    const glm::dvec3 a = scene.positions[triangle.vertices[0]], b = scene.positions[triangle.vertices[1]],
                     c = scene.positions[triangle.vertices[2]];
    return 0.5 * glm::cross(b - a, c - a);
}

// Watts per channel: pi A L of one-sided diffuse emitters; the solid angle of a spot's smooth cone times its intensity.
glm::dvec3 emittedPower(const Scene& scene)
{
    glm::dvec3 power(0);
    for (const Triangle& triangle : scene.triangles) {
        const Material& material = scene.materials[triangle.material];
        EXPECT_FALSE(material.doubleSided);
        power += std::numbers::pi * glm::length(areaNormal(scene, triangle)) * glm::dvec3(material.emission);
    }
    for (const PunctualLight& light : scene.lights) {
        EXPECT_EQ(light.kind, LightKind::Spot);
        EXPECT_NEAR(glm::length(light.direction), 1, 1e-6);
        const double inner = std::cos(light.innerConeAngle), outer = std::cos(light.outerConeAngle);
        power += 2 * std::numbers::pi * ((1 - inner) + (inner - outer) / 3) * glm::dvec3(light.intensity);
    }
    return power;
}

size_t emitterCount(const Scene& scene)
{
    size_t count = 0;
    for (const Triangle& triangle : scene.triangles)
        count += scene.materials[triangle.material].emission != glm::vec3(0);
    return count;
}

bool isLambert(const Material& m)
{
    return m.metallic == 0 && m.specular == 0 && m.transmission == 0 && !m.unlit;
}

TEST(BuiltInScenes, HaveUniqueNamesAndOneLineOfDescription)
{
    std::set<std::string> names;
    for (const BuiltInScene& builtIn : builtInScenes()) {
        EXPECT_TRUE(names.insert(builtIn.name).second) << builtIn.name;
        EXPECT_EQ(builtIn.make().name, builtIn.name);
        const std::string description = builtIn.description;
        EXPECT_GT(description.size(), 20u);
        EXPECT_EQ(description.find('\n'), std::string::npos);
    }
    EXPECT_EQ(names, (std::set<std::string>{"hall", "cornell", "lamps", "dim", "carousel", "flags", "furnace"}));
}

TEST(BuiltInScenes, AreSoundMeshes)
{
    for (const BuiltInScene& builtIn : builtInScenes()) {
        SCOPED_TRACE(builtIn.name);
        const Scene scene = builtIn.make();
        ASSERT_EQ(scene.normals.size(), scene.positions.size());
        EXPECT_TRUE(scene.uv0.empty() && scene.uv1.empty() && scene.tangents.empty() && scene.colors.empty());
        EXPECT_GE(scene.triangles.size(), 30u);
        EXPECT_LE(scene.triangles.size(), 120'000u);
        int bad = 0;
        for (const Triangle& triangle : scene.triangles) {
            ASSERT_LT(triangle.material, scene.materials.size());
            for (const uint32_t vertex : triangle.vertices) ASSERT_LT(vertex, scene.positions.size());
            const glm::dvec3 normal = areaNormal(scene, triangle);
            if (!(glm::length(normal) > 1e-9)) ++bad; // degenerate, or not a number
            // Shading normals lie on the front's side. Sharp folds may bend them far, not over.
            for (const uint32_t vertex : triangle.vertices)
                if (!(glm::dot(glm::dvec3(scene.normals[vertex]), normal) > 0)) ++bad;
        }
        EXPECT_EQ(bad, 0);
        for (const glm::vec3& normal : scene.normals) bad += !(std::abs(glm::length(normal) - 1) < 1e-5f);
        EXPECT_EQ(bad, 0);
        for (const Material& material : scene.materials)
            for (int c = 0; c < 3; ++c) {
                EXPECT_GE(material.baseColor[c], 0) << material.name;
                EXPECT_LE(material.baseColor[c], 0.85f) << material.name;
            }
    }
}

TEST(BuiltInScenes, AreTheSameEveryTime)
{
    for (const BuiltInScene& builtIn : builtInScenes()) {
        const Scene a = builtIn.make(), b = builtIn.make();
        EXPECT_EQ(a.positions, b.positions) << builtIn.name;
        EXPECT_EQ(a.normals, b.normals) << builtIn.name;
        EXPECT_EQ(a.triangles.size(), b.triangles.size()) << builtIn.name;
    }
}

TEST(BuiltInScenes, HaveACameraInsideTheirBounds)
{
    for (const BuiltInScene& builtIn : builtInScenes()) {
        const Scene scene = builtIn.make();
        ASSERT_EQ(scene.cameras.size(), 1u) << builtIn.name;
        if (scene.name == "cornell") continue; // seen from in front
        glm::vec3 low(1e9f), high(-1e9f);
        for (const glm::vec3& p : scene.positions) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        const glm::vec3 eye = scene.cameras[0].position;
        EXPECT_TRUE(glm::all(glm::lessThan(low, eye)) && glm::all(glm::lessThan(eye, high))) << builtIn.name;
    }
}

TEST(BuiltInScenes, CornellIsAllLambertUnderOneLamp)
{
    const Scene scene = makeCornell();
    EXPECT_EQ(scene.triangles.size(), 36u);
    EXPECT_EQ(emitterCount(scene), 2u);
    for (const Material& material : scene.materials) EXPECT_TRUE(isLambert(material));
    const glm::dvec3 power = emittedPower(scene);
    EXPECT_NEAR(power.r, std::numbers::pi * 0.13 * 0.105 * 18, 1e-4);
}

TEST(BuiltInScenes, HallIsLitByColouredSpotlights)
{
    const Scene scene = makeHall();
    EXPECT_EQ(scene.lights.size(), 14u);
    for (const PunctualLight& light : scene.lights) {
        const glm::vec3 i = light.intensity;
        EXPECT_LT(std::min({i.r, i.g, i.b}), 0.1f * std::max({i.r, i.g, i.b})) << "saturated";
    }
    Scene windows = scene;
    windows.lights.clear();
    const glm::dvec3 all = emittedPower(scene), window = emittedPower(windows);
    for (int c = 0; c < 3; ++c) EXPECT_LT(window[c], 0.1 * all[c]);
}

TEST(BuiltInScenes, LampsHasHundredsOfSmallColouredEmitters)
{
    const Scene scene = makeLamps();
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_GT(emitterCount(scene), 20'000u); // 272 bulbs of 80 triangles, lanterns, windows
    std::set<uint32_t> colors;
    for (const Triangle& triangle : scene.triangles) {
        if (scene.materials[triangle.material].emission == glm::vec3(0)) continue;
        colors.insert(triangle.material);
        EXPECT_LT(glm::length(areaNormal(scene, triangle)), 1.0);
    }
    EXPECT_GE(colors.size(), 8u);
}

TEST(BuiltInScenes, DimHasOneWhiteLampBeyondTheDoorway)
{
    const Scene scene = makeDim();
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_EQ(emitterCount(scene), 2u);
    EXPECT_EQ(scene.environment.width, 0u);
    for (const Triangle& triangle : scene.triangles) {
        const glm::vec3 emission = scene.materials[triangle.material].emission;
        EXPECT_EQ(emission.r, emission.g);
        EXPECT_EQ(emission.r, emission.b);
        if (emission.r == 0) continue;
        for (const uint32_t vertex : triangle.vertices) EXPECT_LT(scene.positions[vertex].x, -0.1f);
    }
}

TEST(BuiltInScenes, FurnaceIsClosedConvexAndEmitsOneMinusItsAlbedo)
{
    const Scene scene = makeFurnace();
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_TRUE(isLambert(scene.materials[0]));
    for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(scene.materials[0].baseColor[c], FURNACE_ALBEDO[c]);
        EXPECT_NEAR(scene.materials[0].emission[c] + FURNACE_ALBEDO[c], 1, 1e-7);
    }
    std::map<std::pair<std::tuple<float, float, float>, std::tuple<float, float, float>>, int> edges;
    for (const Triangle& triangle : scene.triangles) {
        const glm::dvec3 normal = glm::normalize(areaNormal(scene, triangle));
        for (size_t i = 0; i < 3; ++i) {
            const glm::vec3 a = scene.positions[triangle.vertices[i]],
                            b = scene.positions[triangle.vertices[(i + 1) % 3]];
            ++edges[{{a.x, a.y, a.z}, {b.x, b.y, b.z}}];
            EXPECT_LT(glm::dot(normal, glm::dvec3(a)), -0.98) << "fronts face the center";
            EXPECT_GT(glm::dot(normal, glm::dvec3(scene.normals[triangle.vertices[i]])), 1 - 1e-6) << "flat";
        }
    }
    for (const auto& [edge, count] : edges) {
        EXPECT_EQ(count, 1);
        EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
    }
}

} // namespace
} // namespace scene
