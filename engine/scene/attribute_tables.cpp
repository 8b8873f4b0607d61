#include "engine/scene/attribute_tables.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "shaders/shared/scene.h"

namespace scene
{

namespace
{

uint32_t bits(float value)
{
    return std::bit_cast<uint32_t>(value);
}

glm::uvec4 row(const glm::vec3& v, uint32_t w)
{
    return {bits(v.x), bits(v.y), bits(v.z), w};
}

// 16 bits a coordinate; shaders/lib/basis.glsl decodes.
uint32_t octahedralEncode(glm::vec3 v)
{
    v /= std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
    glm::vec2 e(v.x, v.y);
    if (v.z < 0) {
        e.x = (1 - std::abs(v.y)) * (v.x >= 0 ? 1.0f : -1.0f);
        e.y = (1 - std::abs(v.x)) * (v.y >= 0 ? 1.0f : -1.0f);
    }
    return glm::packSnorm2x16(e);
}

uint32_t encodeTangent(const glm::vec4& tangent)
{
    return (octahedralEncode(glm::vec3(tangent)) & ~1u) | (tangent.w < 0 ? 1u : 0u);
}

glm::uvec2 encodeColor(const glm::vec4& color)
{
    return {glm::packHalf2x16({color.x, color.y}), glm::packHalf2x16({color.z, color.w})};
}

// The least barycentric weight of points that keep clear of the triangle's edges: by several times what rounding moves
// the point, and rays that leave it (shaders/lib/offset.glsl).
float clearance(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
    const double part = 1.0 / 524288; // 2^-19 of the coordinates
    const glm::dvec3 sizes = glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c)));
    const double size = std::max({sizes.x, sizes.y, sizes.z});
    const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    const double weight = part * size * longest / glm::length(glm::cross(b - a, c - a)); // over the smallest height
    return weight < 1.0 / 3 ? static_cast<float>(weight) : 1.0f / 3;                     // also where it has no height
}

template <class T>
T attributeOr(const std::vector<T>& values, uint32_t vertex, const T& missing)
{
    return values.empty() ? missing : values[vertex];
}

} // namespace

void packAttributes(const Geometry& scene, std::span<const glm::vec3> positions, uint32_t light, size_t index,
                    std::span<glm::uvec4> record)
{
    const size_t rows = record.size();
    const Triangle& triangle = scene.triangles[index];
    const auto& [a, b, c] = triangle.vertices;
    glm::uvec3 tangents;
    for (int i = 0; i < 3; ++i)
        tangents[i] = encodeTangent(attributeOr(scene.tangents, triangle.vertices[size_t(i)], glm::vec4(1, 0, 0, 1)));
    record[0] = row(positions[a], triangle.material);
    record[1] = row(positions[b], light);
    record[2] = row(positions[c], bits(clearance(positions[a], positions[b], positions[c])));
    record[3] = {octahedralEncode(scene.normals[a]), octahedralEncode(scene.normals[b]),
                 octahedralEncode(scene.normals[c]), tangents.z};
    if (rows == shared::ATTRIBUTE_ROWS_BARE) return;
    const auto uv = [&](const std::vector<glm::vec2>& set, uint32_t vertex) {
        const glm::vec2 value = attributeOr(set, vertex, glm::vec2(0));
        return glm::uvec2(bits(value.x), bits(value.y));
    };
    record[4] = {uv(scene.uv0, a), uv(scene.uv0, b)};
    record[5] = {uv(scene.uv0, c), glm::uvec2(tangents)};
    if (rows == shared::ATTRIBUTE_ROWS_UV) return;
    const auto color = [&](uint32_t vertex) { return encodeColor(attributeOr(scene.colors, vertex, glm::vec4(1))); };
    record[6] = {uv(scene.uv1, a), uv(scene.uv1, b)};
    record[7] = {uv(scene.uv1, c), color(a)};
    record[8] = {color(b), color(c)};
}

} // namespace scene
