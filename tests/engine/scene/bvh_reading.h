#pragma once
// Meshes, and trees over them read back from their tables.

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/bvh.h"
#include "engine/scene/bvh_tree.h"
#include "shaders/shared/bvh.h"

using scene::Box;
using scene::Bvh;

inline constexpr uint64_t ANY_SIZE = uint64_t{1} << 40;

struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<scene::Triangle> triangles;

    void add(glm::vec3 a, glm::vec3 b, glm::vec3 c)
    {
        const uint32_t first = uint32_t(positions.size());
        positions.insert(positions.end(), {a, b, c});
        triangles.push_back({.vertices = {first, first + 1, first + 2}});
    }
    std::array<glm::dvec3, 3> corners(uint32_t triangle) const
    {
        const auto& v = triangles[triangle].vertices;
        return {positions[v[0]], positions[v[1]], positions[v[2]]};
    }
    Bvh build(uint64_t maxTableBytes = ANY_SIZE) const
    {
        return scene::buildBvh({.positions = positions, .triangles = triangles}, maxTableBytes);
    }
};

// Reads the tables as shared/bvh.h describes them.
struct Slot {
    Box box;
    std::optional<uint32_t> node;
    std::vector<uint32_t> triangles;
};

inline const glm::uvec4* recordOf(const Bvh& bvh, size_t record)
{
    return &bvh.triangles[record * shared::BVH_RECORD_STRIDE];
}

inline std::vector<uint32_t> trianglesOf(const Bvh& bvh, size_t record)
{
    const glm::uvec4* words = recordOf(bvh, record);
    std::vector<uint32_t> triangles = {words[0].w & ~shared::BVH_ALPHA_FLAG};
    if (glm::uvec3(words[3]) != glm::uvec3(words[1])) triangles.push_back(words[1].w);
    return triangles;
}

inline std::vector<Slot> slotsOf(const Bvh& bvh, uint32_t node)
{
    const glm::uvec4* words = &bvh.nodes[size_t{node} * shared::BVH_NODE_STRIDE];
    const auto byteOf = [&](uint32_t plane, uint32_t slot) {
        const uint32_t word = 2 * plane + slot / 4;
        return words[2 + word / 4][int(word % 4)] >> (8 * (slot % 4)) & 255u;
    };
    std::vector<Slot> slots;
    uint32_t nextRecord = words[1].z;
    for (uint32_t s = 0; s < 8; ++s) {
        Slot slot;
        for (int axis = 0; axis < 3; ++axis) {
            const float corner = std::bit_cast<float>(words[0][axis]);
            const double step = std::ldexp(1.0, int(words[0].w >> (8 * axis) & 255u) - 127);
            slot.box.lower[axis] = float(corner + step * byteOf(uint32_t(axis), s));
            slot.box.upper[axis] = float(corner + step * byteOf(uint32_t(axis) + 3, s));
        }
        if ((words[1].x >> (24 + s) & 1u) != 0) slot.node = (words[1].y >> 8) + s;
        for (uint32_t k = 0; k < 3; ++k)
            if ((words[1].x >> (3 * s + k) & 1u) != 0)
                for (const uint32_t triangle : trianglesOf(bvh, nextRecord++)) slot.triangles.push_back(triangle);
        if (slot.node || !slot.triangles.empty()) slots.push_back(slot);
    }
    return slots;
}

template <class Enter, class Visit>
void walk(const Bvh& bvh, const Enter& enter, const Visit& visit, uint32_t node = 0)
{
    for (const Slot& slot : slotsOf(bvh, node)) {
        if (!enter(slot.box)) continue;
        for (const uint32_t triangle : slot.triangles) visit(triangle);
        if (slot.node) walk(bvh, enter, visit, *slot.node);
    }
}

inline bool contains(const Box& box, glm::dvec3 p)
{
    return glm::all(glm::lessThanEqual(glm::dvec3(box.lower), p)) &&
           glm::all(glm::greaterThanEqual(glm::dvec3(box.upper), p));
}

inline std::multiset<uint32_t> reachable(const Bvh& bvh)
{
    std::multiset<uint32_t> found;
    walk(
        bvh, [](const Box&) { return true; }, [&](uint32_t triangle) { found.insert(triangle); });
    return found;
}

struct RayD {
    glm::dvec3 origin, direction;
};

inline double hitDistance(const std::array<glm::dvec3, 3>& v, const RayD& ray)
{
    const glm::dvec3 e1 = v[1] - v[0], e2 = v[2] - v[0], s = ray.origin - v[0];
    const glm::dvec3 p = glm::cross(ray.direction, e2), q = glm::cross(s, e1);
    const double det = glm::dot(e1, p);
    const double a = glm::dot(s, p) / det, b = glm::dot(ray.direction, q) / det, t = glm::dot(e2, q) / det;
    const bool hit = a >= 0 && b >= 0 && a + b <= 1 && t >= 0;
    return hit ? t : std::numeric_limits<double>::infinity();
}

inline bool meets(const Box& box, const RayD& ray)
{
    double enter = 0, leave = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (double(box.lower[axis]) - ray.origin[axis]) / ray.direction[axis];
        const double b = (double(box.upper[axis]) - ray.origin[axis]) / ray.direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave;
}

inline scene::BvhInput inputOf(const Mesh& mesh)
{
    return {.positions = mesh.positions, .triangles = mesh.triangles};
}
