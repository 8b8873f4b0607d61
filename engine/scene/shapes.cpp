#include "engine/scene/shapes.h"

#include "engine/base/check.h"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>

namespace scene
{

namespace
{

constexpr float TWO_PI = 2 * std::numbers::pi_v<float>;

uint32_t addVertex(Scene& scene, glm::vec3 position, glm::vec3 normal)
{
    scene.positions.push_back(position);
    scene.normals.push_back(normal);
    return static_cast<uint32_t>(scene.positions.size() - 1);
}

} // namespace

uint32_t addMaterial(Scene& scene, const Material& material)
{
    scene.materials.push_back(material);
    return static_cast<uint32_t>(scene.materials.size() - 1);
}

Material diffuse(const char* name, glm::vec3 color)
{
    return {.name = name, .baseColor = glm::vec4(color, 1), .metallic = 0, .specular = 0};
}

Material emitter(const char* name, glm::vec3 radiance)
{
    Material material = diffuse(name, glm::vec3(0));
    material.emission = radiance;
    return material;
}

Material glossy(const char* name, glm::vec3 color, float roughness)
{
    return {.name = name, .baseColor = glm::vec4(color, 1), .metallic = 0, .roughness = roughness};
}

void addQuad(Scene& scene, uint32_t material, glm::vec3 corner, glm::vec3 u, glm::vec3 v)
{
    const glm::vec3 normal = glm::normalize(glm::cross(u, v));
    const uint32_t a = addVertex(scene, corner, normal);
    const uint32_t b = addVertex(scene, corner + u, normal);
    const uint32_t c = addVertex(scene, corner + u + v, normal);
    const uint32_t d = addVertex(scene, corner + v, normal);
    scene.triangles.push_back({{a, b, c}, material});
    scene.triangles.push_back({{a, c, d}, material});
}

void addBox(Scene& scene, uint32_t material, const glm::mat4& transform)
{
    CHECK(glm::determinant(glm::mat3(transform)) > 0);
    // Each corner is computed once, so that the six faces share exact positions.
    glm::vec3 corners[8];
    for (int i = 0; i < 8; ++i)
        corners[i] = glm::vec3(transform * glm::vec4(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1, 1));
    const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& face : faces) {
        const glm::vec3 normal =
            glm::normalize(glm::cross(corners[face[1]] - corners[face[0]], corners[face[3]] - corners[face[0]]));
        uint32_t v[4];
        for (int i = 0; i < 4; ++i) v[i] = addVertex(scene, corners[face[i]], normal);
        scene.triangles.push_back({{v[0], v[1], v[2]}, material});
        scene.triangles.push_back({{v[0], v[2], v[3]}, material});
    }
}

void addBox(Scene& scene, uint32_t material, glm::vec3 low, glm::vec3 high)
{
    addBox(scene, material, glm::scale(glm::translate(glm::mat4(1), 0.5f * (low + high)), 0.5f * (high - low)));
}

void addSphere(Scene& scene, uint32_t material, glm::vec3 center, float radius, uint32_t subdivisions, Normals normals,
               Facing facing)
{
    const float t = std::numbers::phi_v<float>;
    std::vector<glm::vec3> points = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                                     {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
    for (glm::vec3& p : points) p = glm::normalize(p);
    std::vector<std::array<uint32_t, 3>> faces = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                                  {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                                  {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                                  {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (uint32_t i = 0; i < subdivisions; ++i) {
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
        const auto middle = [&](uint32_t a, uint32_t b) {
            const auto [it, isNew] = middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(points.size()));
            if (isNew) points.push_back(glm::normalize(points[a] + points[b]));
            return it->second;
        };
        std::vector<std::array<uint32_t, 3>> finer;
        for (const auto& [a, b, c] : faces) {
            const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        faces = std::move(finer);
    }

    const bool inward = facing == Facing::Inward;
    const float side = inward ? -1.0f : 1.0f;
    const uint32_t first = static_cast<uint32_t>(scene.positions.size());
    if (normals == Normals::Smooth)
        for (const glm::vec3& p : points) addVertex(scene, center + radius * p, side * p);
    for (auto [a, b, c] : faces) {
        if (inward) std::swap(b, c);
        if (normals == Normals::Smooth) {
            scene.triangles.push_back({{first + a, first + b, first + c}, material});
            continue;
        }
        const glm::vec3 normal = glm::normalize(glm::cross(points[b] - points[a], points[c] - points[a]));
        Triangle triangle{{}, material};
        for (const auto& [corner, point] : {std::pair(0, a), std::pair(1, b), std::pair(2, c)})
            triangle.vertices[static_cast<size_t>(corner)] = addVertex(scene, center + radius * points[point], normal);
        scene.triangles.push_back(triangle);
    }
}

void addSurface(Scene& scene, uint32_t material, Grid grid, const std::function<glm::vec3(float, float)>& position)
{
    const uint32_t vertexColumns = grid.closed ? grid.columns : grid.columns + 1;
    const uint32_t first = static_cast<uint32_t>(scene.positions.size());
    for (uint32_t row = 0; row <= grid.rows; ++row)
        for (uint32_t column = 0; column < vertexColumns; ++column)
            addVertex(scene,
                      position(static_cast<float>(column) / static_cast<float>(grid.columns),
                               static_cast<float>(row) / static_cast<float>(grid.rows)),
                      glm::vec3(0));

    const auto addTriangle = [&](uint32_t a, uint32_t b, uint32_t c) {
        const glm::vec3 u = scene.positions[b] - scene.positions[a], v = scene.positions[c] - scene.positions[a];
        const glm::vec3 normal = glm::cross(u, v); // twice the area long: vertex normals are area-weighted means
        if (glm::length(normal) <= 1e-6f * std::max(glm::dot(u, u), glm::dot(v, v))) return;
        for (const uint32_t vertex : {a, b, c}) scene.normals[vertex] += normal;
        scene.triangles.push_back({{a, b, c}, material});
    };
    for (uint32_t row = 0; row < grid.rows; ++row)
        for (uint32_t column = 0; column < grid.columns; ++column) {
            const uint32_t next = (column + 1) % vertexColumns;
            const uint32_t a = first + row * vertexColumns + column, b = first + row * vertexColumns + next;
            const uint32_t c = b + vertexColumns, d = a + vertexColumns;
            addTriangle(a, b, c);
            addTriangle(a, c, d);
        }
    for (size_t i = first; i < scene.normals.size(); ++i) {
        const float length = glm::length(scene.normals[i]);
        scene.normals[i] = length > 0 ? scene.normals[i] / length : glm::vec3(0, 1, 0); // unused, at a pole
    }
}

void addLathe(Scene& scene, uint32_t material, glm::vec3 base, std::span<const glm::vec2> profile, uint32_t segments)
{
    // The angle runs so that cross(around, up) points away from the axis.
    for (size_t i = 0; i + 1 < profile.size(); ++i)
        addSurface(scene, material, {segments, 1, true}, [&](float s, float t) {
            const glm::vec2 point = t == 0 ? profile[i] : profile[i + 1];
            return base + glm::vec3(point.x * std::sin(TWO_PI * s), point.y, point.x * std::cos(TWO_PI * s));
        });
}

void addBar(Scene& scene, uint32_t material, glm::vec3 from, glm::vec3 to, float radius, uint32_t segments)
{
    const glm::vec3 axis = glm::normalize(to - from);
    const glm::vec3 x =
        glm::normalize(glm::cross(std::abs(axis.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0), axis));
    const glm::vec3 y = glm::cross(axis, x);
    addSurface(scene, material, {segments, 1, true}, [&](float s, float t) {
        return (t == 0 ? from : to) + radius * (std::cos(TWO_PI * s) * x + std::sin(TWO_PI * s) * y);
    });
}

Camera lookAt(const char* name, glm::dvec3 position, glm::dvec3 target, double fieldDegrees)
{
    Camera camera;
    camera.name = name;
    camera.yfov = glm::radians(fieldDegrees);
    camera.position = position;
    camera.target = target;
    camera.forward = glm::normalize(target - position);
    camera.right = glm::normalize(glm::cross(camera.forward, glm::dvec3(0, 1, 0)));
    camera.up = glm::cross(camera.right, camera.forward);
    return camera;
}

} // namespace scene
