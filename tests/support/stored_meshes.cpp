#include "tests/support/stored_meshes.h"

#include <map>
#include <utility>

namespace support
{

namespace
{

template <class T>
void append(std::vector<T>& to, size_t before, const std::vector<T>& from, size_t count, const T& absent)
{
    if (to.empty() && from.empty()) return;
    to.resize(before, absent);
    to.insert(to.end(), from.begin(), from.end());
    to.resize(before + count, absent);
}

void append(scene::Scene& scene, const scene::Geometry& mesh, const glm::dmat4& worldFromMesh)
{
    const glm::dmat3 linear(worldFromMesh);
    const bool mirrors = glm::determinant(linear) < 0;
    const glm::dmat3 normals = glm::transpose(glm::inverse(linear));
    const size_t before = scene.positions.size(), count = mesh.positions.size();
    for (size_t v = 0; v < count; ++v) {
        scene.positions.emplace_back(worldFromMesh * glm::dvec4(glm::dvec3(mesh.positions[v]), 1));
        scene.normals.emplace_back(glm::normalize(normals * glm::dvec3(mesh.normals[v])));
    }
    std::vector<glm::vec4> tangents;
    for (const glm::vec4& tangent : mesh.tangents)
        tangents.emplace_back(glm::normalize(linear * glm::dvec3(glm::vec3(tangent))),
                              mirrors ? -tangent.w : tangent.w);
    append(scene.tangents, before, tangents, count, glm::vec4(1, 0, 0, 1));
    append(scene.uv0, before, mesh.uv0, count, glm::vec2(0));
    append(scene.uv1, before, mesh.uv1, count, glm::vec2(0));
    append(scene.colors, before, mesh.colors, count, glm::vec4(1));
    for (scene::Triangle triangle : mesh.triangles) {
        for (uint32_t& vertex : triangle.vertices) vertex += uint32_t(before);
        if (mirrors) std::swap(triangle.vertices[1], triangle.vertices[2]);
        scene.triangles.push_back(triangle);
    }
}

} // namespace

scene::Scene expanded(const scene::Scene& scene)
{
    scene::Scene flat = scene;
    flat.instances.clear();
    flat.meshes.clear();
    for (const scene::Instance& instance : scene.instances)
        if (instance.visible) append(flat, scene.meshes[instance.mesh], instance.worldFromMesh);
    return flat;
}

scene::Scene storedOnce(scene::Scene scene, uint32_t material, const std::vector<glm::dmat4>& places)
{
    scene::Geometry mesh;
    std::map<uint32_t, uint32_t> vertexOf;
    const auto copy = [](auto& to, const auto& from, uint32_t vertex) {
        if (!from.empty()) to.push_back(from[vertex]);
    };
    std::vector<scene::Triangle> others;
    for (scene::Triangle triangle : scene.triangles) {
        if (triangle.material != material) {
            others.push_back(triangle);
            continue;
        }
        for (uint32_t& vertex : triangle.vertices) {
            const auto [found, isNew] = vertexOf.try_emplace(vertex, uint32_t(mesh.positions.size()));
            if (isNew) {
                copy(mesh.positions, scene.positions, vertex);
                copy(mesh.normals, scene.normals, vertex);
                copy(mesh.tangents, scene.tangents, vertex);
                copy(mesh.uv0, scene.uv0, vertex);
                copy(mesh.uv1, scene.uv1, vertex);
                copy(mesh.colors, scene.colors, vertex);
            }
            vertex = found->second;
        }
        mesh.triangles.push_back(triangle);
    }
    scene.triangles = others;
    for (const glm::dmat4& place : places)
        scene.instances.push_back({.mesh = uint32_t(scene.meshes.size()), .worldFromMesh = place});
    scene.meshes.push_back(mesh);
    return scene;
}

scene::Scene storedInPlace(scene::Scene scene, uint32_t material, const glm::dmat4& place)
{
    scene = storedOnce(std::move(scene), material, {glm::inverse(place)});
    scene::Scene alone;
    alone.meshes = {scene.meshes.back()};
    alone.instances = {{.worldFromMesh = glm::inverse(place)}};
    scene.meshes.back() = expanded(alone);
    scene.instances.back().worldFromMesh = place;
    return scene;
}

} // namespace support
