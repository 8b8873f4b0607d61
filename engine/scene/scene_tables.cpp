#include "engine/scene/scene_tables.h"

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/scene/light_tables.h"
#include "engine/scene/material_tables.h"

#include <bit>
#include <cmath>

#include <glm/gtc/packing.hpp>

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

// 2^-round(log2(size)): brings `size` near 1 without rounding anything.
double powerOfTwoScale(double size)
{
    return size > 0 && std::isfinite(size) ? std::exp2(-std::round(std::log2(size))) : 1;
}

double radiusOf(const Scene& scene)
{
    double squared = 0;
    for (const Triangle& triangle : scene.triangles)
        for (const uint32_t vertex : triangle.vertices) {
            const glm::dvec3 p(scene.positions[vertex]);
            squared = std::max(squared, glm::dot(p, p));
        }
    return std::sqrt(squared);
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

SceneFeatures everything()
{
    SceneFeatures features{.blend = true};
#define ADD_FEATURE(ID, TYPE, NAME, DEFAULT, WHAT) features.NAME = true;
    SCENE_FEATURES(ADD_FEATURE)
#undef ADD_FEATURE
    return features;
}

uint32_t attributeRows(const SceneFeatures& features)
{
    if (features.HAS_SECOND_UV || features.HAS_VERTEX_COLORS) return shared::ATTRIBUTE_ROWS_FULL;
    const bool textured = features.HAS_BASE_COLOR_TEXTURE || features.HAS_METALLIC_ROUGHNESS_TEXTURE ||
                          features.HAS_NORMAL_MAP || features.HAS_EMISSIVE_TEXTURE ||
                          features.HAS_TRANSMISSION_TEXTURE || features.HAS_SPECULAR_TEXTURE;
    return textured ? shared::ATTRIBUTE_ROWS_UV : shared::ATTRIBUTE_ROWS_BARE;
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

std::vector<glm::uvec4> packAttributes(const Scene& scene, const std::vector<glm::vec3>& positions, uint32_t rows,
                                       const std::vector<uint32_t>& lightOfTriangle)
{
    std::vector<glm::uvec4> table;
    table.reserve(scene.triangles.size() * rows);
    for (size_t t = 0; t < scene.triangles.size(); ++t) {
        const Triangle& triangle = scene.triangles[t];
        const auto& [a, b, c] = triangle.vertices;
        glm::uvec3 tangents;
        for (int i = 0; i < 3; ++i)
            tangents[i] =
                encodeTangent(attributeOr(scene.tangents, triangle.vertices[size_t(i)], glm::vec4(1, 0, 0, 1)));
        table.push_back(row(positions[a], triangle.material));
        table.push_back(row(positions[b], lightOfTriangle[t]));
        table.push_back(row(positions[c], bits(clearance(positions[a], positions[b], positions[c]))));
        table.emplace_back(octahedralEncode(scene.normals[a]), octahedralEncode(scene.normals[b]),
                           octahedralEncode(scene.normals[c]), tangents.z);
        if (rows == shared::ATTRIBUTE_ROWS_BARE) continue;
        const auto uv = [&](const std::vector<glm::vec2>& set, uint32_t vertex) {
            const glm::vec2 value = attributeOr(set, vertex, glm::vec2(0));
            return glm::uvec2(bits(value.x), bits(value.y));
        };
        table.emplace_back(uv(scene.uv0, a), uv(scene.uv0, b));
        table.emplace_back(uv(scene.uv0, c), glm::uvec2(tangents));
        if (rows == shared::ATTRIBUTE_ROWS_UV) continue;
        const auto color = [&](uint32_t vertex) {
            return encodeColor(attributeOr(scene.colors, vertex, glm::vec4(1)));
        };
        table.emplace_back(uv(scene.uv1, a), uv(scene.uv1, b));
        table.emplace_back(uv(scene.uv1, c), color(a));
        table.emplace_back(color(b), color(c));
    }
    return table;
}

void requireFits(const char* what, uint64_t rows, uint64_t maxTableBytes)
{
    if (rows * sizeof(glm::uvec4) > maxTableBytes)
        throw Error("The scene's {} need {} bytes, more than the device's limit of {} for one table.", what,
                    rows * sizeof(glm::uvec4), maxTableBytes);
}

} // namespace

SceneTables makeSceneTables(const Scene& scene, uint64_t maxTableBytes, const std::function<void(double)>& bvhProgress,
                            FeatureSet featureSet)
{
    SceneTables tables;
    const double radius = radiusOf(scene);
    tables.lengthScale = powerOfTwoScale(radius);

    std::vector<glm::vec3> positions(scene.positions.size());
    for (size_t i = 0; i < positions.size(); ++i)
        positions[i] = glm::vec3(glm::dvec3(scene.positions[i]) * tables.lengthScale);

    const LightTables lights = makeLightTables(scene, positions, tables.lengthScale, radius * tables.lengthScale);
    tables.radianceScale = lights.radianceScale;
    tables.lights = lights.counts;
    MaterialTables materials = makeMaterialTables(scene, tables.radianceScale);
    tables.features = materials.features;
    tables.features.HAS_EMISSIVE = lights.counts.emissiveTriangles > 0;
    tables.features.HAS_PUNCTUAL = lights.counts.points + lights.counts.spots > 0;
    tables.features.HAS_DIRECTIONAL = lights.counts.directionals > 0;
    tables.features.HAS_ENVIRONMENT = lights.counts.environments > 0;

    if (featureSet == FeatureSet::Everything) tables.features = everything();

    shared::SceneUniform& uniform = tables.uniform;
    uniform.attributeRows = attributeRows(tables.features);
    requireFits("triangles", scene.triangles.size() * uniform.attributeRows, maxTableBytes);
    tables.attributes = packAttributes(scene, positions, uniform.attributeRows, lights.lightOfTriangle);
    tables.texels = std::move(materials.texels);

    const auto append = [&](const std::vector<glm::uvec4>& rows) {
        const uint32_t offset = uint32_t(tables.sceneData.size());
        tables.sceneData.insert(tables.sceneData.end(), rows.begin(), rows.end());
        return offset;
    };
    uniform.materialOffset = append(materials.rows);
    uniform.lightOffset = append(lights.lights);
    uniform.punctualOffset = append(lights.punctual);
    const bool black =
        tables.features.HAS_ENVIRONMENT && lights.environment.empty(); // asked for, but the scene has none
    uniform.environmentOffset = append(black ? std::vector<glm::uvec4>{glm::uvec4(0)} : lights.environment);
    uniform.environmentAliasOffset = append(lights.environmentAliases);
    uniform.lightCount = uint32_t(lights.lights.size());
    uniform.environmentWidth = black ? 1 : scene.environment.width;
    uniform.environmentHeight = black ? 1 : scene.environment.height;
    uniform.environmentPick = lights.environmentPick;
    uniform.radius = float(radius * tables.lengthScale);
    requireFits("textures", tables.texels.size(), maxTableBytes);
    requireFits("materials and lights", tables.sceneData.size(), maxTableBytes);

    std::vector<uint8_t> needsAlphaTest;
    if (tables.features.HAS_ALPHA) {
        needsAlphaTest.resize(scene.triangles.size());
        for (size_t t = 0; t < needsAlphaTest.size(); ++t)
            needsAlphaTest[t] = scene.materials[scene.triangles[t].material].alpha != Alpha::Opaque;
    }
    tables.bvh = buildBvh({.positions = positions,
                           .triangles = scene.triangles,
                           .needsAlphaTest = needsAlphaTest,
                           .progress = bvhProgress},
                          maxTableBytes);
    return tables;
}

} // namespace scene
