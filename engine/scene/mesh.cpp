#include "engine/scene/mesh.h"

#include <algorithm>
#include <cmath>

#include "engine/base/check.h"
#include "engine/scene/placing.h"

namespace scene
{

namespace
{

// cof(M) (a x b) = (M a) x (M b): what normals and areas transform by. Exists for singular matrices too.
glm::dmat3 cofactor(const glm::dmat3& m)
{
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

// A transform with what follows from it.
struct Linear {
    explicit Linear(const glm::dmat4& from)
        : world(from), normals(cofactor(glm::dmat3(from))), side(glm::determinant(glm::dmat3(from)) < 0 ? -1 : 1)
    {
    }
    glm::dmat4 world;
    glm::dmat3 normals;
    double side; // -1: it mirrors
};

std::span<const Influence> influencesOf(const MeshVertices& vertices, size_t v)
{
    if (vertices.influenceEnds.empty()) return {};
    const uint32_t begin = v == 0 ? 0 : vertices.influenceEnds[v - 1];
    return std::span(vertices.influences).subspan(begin, vertices.influenceEnds[v] - begin);
}

// glTF 2.0, 3.7.3.3: the weighted sum of the joints' transforms. Weights that do not sum to 1 are made to.
glm::dmat4 skinTransform(std::span<const Influence> influences, const Placement& placement)
{
    glm::dmat4 sum(0);
    double total = 0;
    for (const auto& [joint, weight] : influences) {
        CHECK_LT(joint, placement.worldFromSkin.size());
        sum += weight * placement.worldFromSkin[joint];
        total += weight;
    }
    return total == 0 ? placement.worldFromMesh : sum / total;
}

// An attribute with its morph targets added (3.7.2.2); `sum` is where to, where something is added.
const std::vector<double>& morphed(const MeshVertices& vertices, Attribute attribute, std::span<const double> weights,
                                   std::vector<double>& sum)
{
    const std::vector<double>& base = vertices.values[attribute];
    const uint32_t width = ATTRIBUTE_WIDTH[attribute];
    bool changed = false;
    for (size_t t = 0; t < std::min(weights.size(), vertices.targets.size()); ++t) {
        const Displacements& added = vertices.targets[t][attribute];
        if (weights[t] == 0 || added.vertices.empty()) continue;
        if (!changed) sum = base;
        changed = true;
        for (size_t i = 0; i < added.vertices.size(); ++i) {
            for (uint32_t c = 0; c < width; ++c)
                sum[size_t{added.vertices[i]} * width + c] += weights[t] * added.values[i * width + c];
        }
    }
    return changed ? sum : base;
}

void duplicate(MeshVertices& vertices, uint32_t original)
{
    const auto copy = static_cast<uint32_t>(vertices.count++);
    for (uint32_t a = 0; a < ATTRIBUTES; ++a) {
        const size_t width = ATTRIBUTE_WIDTH[a];
        for (size_t c = 0; c < width && !vertices.values[a].empty(); ++c)
            vertices.values[a].push_back(double(vertices.values[a][original * width + c]));
        for (MorphTarget& target : vertices.targets) {
            Displacements& moved = target[a];
            const auto found = std::ranges::lower_bound(moved.vertices, original);
            if (found == moved.vertices.end() || *found != original) continue;
            const auto at = static_cast<size_t>(found - moved.vertices.begin()) * width;
            moved.vertices.push_back(copy);
            for (size_t c = 0; c < width; ++c) moved.values.push_back(double(moved.values[at + c]));
        }
    }
    if (vertices.influenceEnds.empty()) return;
    const auto size = static_cast<std::ptrdiff_t>(influencesOf(vertices, original).size());
    for (std::ptrdiff_t i = 0; i < size; ++i)
        vertices.influences.push_back(Influence(influencesOf(vertices, original)[static_cast<size_t>(i)]));
    vertices.influenceEnds.push_back(static_cast<uint32_t>(vertices.influences.size()));
}

} // namespace

bool isFinite(const glm::dvec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool isFinite(const MeshPart& part, const std::array<uint32_t, 3>& triangle)
{
    return std::ranges::all_of(triangle, [&](uint32_t v) { return isFinite(part.vertices[v].position); });
}

void poseVertices(const MeshVertices& vertices, const Placement& placement, std::span<Vertex> posed, Replaced& replaced)
{
    CHECK_EQ(posed.size(), vertices.count);
    std::array<std::vector<double>, ATTRIBUTES> sums;
    std::array<const std::vector<double>*, ATTRIBUTES> values;
    for (uint32_t a = 0; a < ATTRIBUTES; ++a)
        values[a] = &morphed(vertices, Attribute(a), placement.morphWeights, sums[a]);
    const auto at = [&](Attribute a, size_t v) { return values[a]->data() + v * ATTRIBUTE_WIDTH[a]; };
    const auto vec3 = [&](Attribute a, size_t v) { return glm::dvec3(at(a, v)[0], at(a, v)[1], at(a, v)[2]); };
    const auto has = [&](Attribute a) { return !values[a]->empty(); };

    const bool skinned = !placement.worldFromSkin.empty() && !vertices.influenceEnds.empty();
    Linear transform(placement.worldFromMesh);
    for (size_t v = 0; v < posed.size(); ++v) {
        if (skinned) transform = Linear(skinTransform(influencesOf(vertices, v), placement));
        Vertex& vertex = posed[v];
        vertex.mirrored = transform.side < 0;
        vertex.position = glm::dvec3(transform.world * glm::dvec4(vec3(POSITION, v), 1));
        if (has(NORMAL)) {
            vertex.normal = unitOrZero(transform.side * (transform.normals * vec3(NORMAL, v)));
            if (vertex.normal == glm::dvec3(0)) ++replaced.normals;
        }
        if (has(TANGENT)) {
            const double handedness = at(TANGENT, v)[3];
            const glm::dvec3 direction = unitOrZero(glm::dmat3(transform.world) * vec3(TANGENT, v));
            if (handedness != 0 && direction != glm::dvec3(0))
                vertex.tangent = {direction, handedness < 0 ? -transform.side : transform.side};
        }
        for (const uint32_t set : {0u, 1u}) {
            const auto attribute = Attribute(TEXCOORD_0 + set);
            if (!has(attribute)) continue;
            constexpr double LARGEST = 1e6; // where float32 has lost the texel anyway
            const glm::dvec2 value(at(attribute, v)[0], at(attribute, v)[1]);
            if (std::abs(value.x) < LARGEST && std::abs(value.y) < LARGEST)
                vertex.uv[set] = value;
            else
                ++replaced.uvs;
        }
        for (uint32_t c = 0; has(COLOR_0) && c < 4; ++c) {
            const double value = at(COLOR_0, v)[c];
            vertex.color[static_cast<int>(c)] =
                static_cast<float>(std::clamp(std::isnan(value) ? 1.0 : value, 0.0, 1.0));
            if (!(value >= 0 && value <= 1)) ++replaced.colors;
        }
    }
}

void turnMirrored(MeshPart& part)
{
    for (auto& triangle : part.triangles) {
        if (part.vertices[triangle[0]].mirrored) std::swap(triangle[1], triangle[2]);
    }
}

void completeNormals(MeshPart& part)
{
    std::vector<glm::dvec3> sums(part.vertices.size(), glm::dvec3(0)); // weighted by area
    for (const auto& triangle : part.triangles) {
        if (!isFinite(part, triangle)) continue;
        const auto& [a, b, c] = triangle;
        const glm::dvec3& origin = part.vertices[a].position;
        const glm::dvec3 area = glm::cross(part.vertices[b].position - origin, part.vertices[c].position - origin);
        for (const uint32_t v : triangle) sums[v] += area;
    }
    for (size_t v = 0; v < part.vertices.size(); ++v) {
        glm::dvec3& normal = part.vertices[v].normal;
        if (normal == glm::dvec3(0)) normal = unitOrZero(sums[v]);
        if (normal == glm::dvec3(0)) normal = {0, 0, 1}; // of no triangle with an area
    }
}

MeshPart poseMesh(const Mesh& mesh, const Placement& placement, const TextureUse& normalTexture)
{
    const auto& values = mesh.vertices.values;
    MeshPart part{.vertices = std::vector<Vertex>(mesh.vertices.count),
                  .triangles = mesh.triangles,
                  .hasUv = {!values[TEXCOORD_0].empty(), !values[TEXCOORD_1].empty()},
                  .hasTangents = mesh.hasTangents,
                  .hasColors = !values[COLOR_0].empty()};
    poseVertices(mesh.vertices, placement, part.vertices, part.replaced);
    turnMirrored(part);
    completeNormals(part);
    if (part.hasTangents) completeTangents(part, normalTexture, false);
    return part;
}

void splitSeams(Mesh& mesh, const TextureUse& use)
{
    if (!mesh.hasTangents) return;
    MeshPart part{.vertices = std::vector<Vertex>(mesh.vertices.count), .triangles = mesh.triangles};
    poseVertices(mesh.vertices, {}, part.vertices, part.replaced);
    completeNormals(part);
    for (const uint32_t original : completeTangents(part, use, true)) duplicate(mesh.vertices, original);
    mesh.triangles = std::move(part.triangles);
}

} // namespace scene
