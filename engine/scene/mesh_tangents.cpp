// Tangents from texture coordinates, per vertex: the texture's u direction in the surface, weighted by the corner's
// angle as in MikkTSpace (Mikkelsen 2008), which glTF names as its reference.

#include "engine/scene/mesh.h"

#include <algorithm>
#include <cmath>

#include "engine/scene/placing.h"

namespace scene
{

namespace
{

// The u direction and the side of a triangle: -1 where the texture is mirrored, 0 where it has no area.
struct TextureFrame {
    glm::dvec3 alongU = {0, 0, 0};
    int side = 0;
};

TextureFrame textureFrame(const std::array<glm::dvec3, 3>& positions, const std::array<glm::dvec2, 3>& uvs)
{
    const glm::dvec3 e1 = positions[1] - positions[0], e2 = positions[2] - positions[0];
    const glm::dvec2 d1 = uvs[1] - uvs[0], d2 = uvs[2] - uvs[0];
    const double area = d1.x * d2.y - d2.x * d1.y;
    if (area == 0) return {};
    // With v running down the picture, an unmirrored texture turns clockwise in (u, v) where the triangle turns
    // counter-clockwise: then cross(normal, tangent) runs up the picture, which is the green axis of a normal map.
    return {(d2.y * e1 - d1.y * e2) / area, area < 0 ? 1 : -1};
}

double angleBetween(const glm::dvec3& a, const glm::dvec3& b)
{
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// In the tangent plane of `normal`.
glm::dvec3 projected(const glm::dvec3& v, const glm::dvec3& normal)
{
    return v - normal * glm::dot(v, normal);
}

glm::dvec3 anyPerpendicular(const glm::dvec3& normal)
{
    const glm::dvec3 axis = std::abs(normal.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    return glm::normalize(projected(axis, normal));
}

} // namespace

std::vector<uint32_t> completeTangents(MeshPart& part, const TextureUse& use, bool split)
{
    const auto isMissing = [](const Vertex& vertex) { return vertex.tangent.w == 0; };
    if (std::none_of(part.vertices.begin(), part.vertices.end(), isMissing)) return {};

    const auto uvOf = [&](const Vertex& vertex) {
        const glm::dvec3 uv(vertex.uv[use.uvSet], 1);
        return glm::dvec2(glm::dot(glm::dvec3(use.row0), uv), glm::dot(glm::dvec3(use.row1), uv));
    };
    std::vector<glm::dvec3> sums(part.vertices.size(), glm::dvec3(0));
    std::vector<int> sides(part.vertices.size(), 0);
    std::vector<uint32_t> twins(part.vertices.size(), NONE); // the copy of a vertex for the other side
    const size_t originalCount = part.vertices.size();
    std::vector<uint32_t> originals; // of the copies
    for (auto& triangle : part.triangles) {
        if (!isFinite(part, triangle)) continue;
        std::array<glm::dvec3, 3> positions;
        std::array<glm::dvec2, 3> uvs;
        for (size_t i = 0; i < 3; ++i) {
            positions[i] = part.vertices[triangle[i]].position;
            uvs[i] = uvOf(part.vertices[triangle[i]]);
        }
        const TextureFrame frame = textureFrame(positions, uvs);
        if (frame.side == 0) continue;
        for (size_t i = 0; i < 3; ++i) {
            uint32_t& corner = triangle[i];
            if (!isMissing(part.vertices[corner])) continue;
            if (split && sides[corner] == -frame.side && corner < originalCount) {
                if (twins[corner] == NONE) {
                    twins[corner] = static_cast<uint32_t>(part.vertices.size());
                    const Vertex copy = part.vertices[corner];
                    part.vertices.push_back(copy);
                    originals.push_back(corner);
                    sums.emplace_back(0);
                    sides.push_back(frame.side);
                }
                corner = twins[corner];
            }
            sides[corner] = frame.side;
            const glm::dvec3& normal = part.vertices[corner].normal;
            const glm::dvec3 to1 = positions[(i + 1) % 3] - positions[i], to2 = positions[(i + 2) % 3] - positions[i];
            sums[corner] += angleBetween(projected(to1, normal), projected(to2, normal)) *
                            unitOrZero(projected(frame.alongU, normal));
        }
    }
    for (size_t v = 0; v < part.vertices.size(); ++v) {
        Vertex& vertex = part.vertices[v];
        if (!isMissing(vertex)) continue;
        glm::dvec3 tangent = unitOrZero(projected(sums[v], vertex.normal));
        if (tangent == glm::dvec3(0)) tangent = anyPerpendicular(vertex.normal);
        vertex.tangent = {tangent, sides[v] < 0 ? -1 : 1};
    }
    return originals;
}

} // namespace scene
