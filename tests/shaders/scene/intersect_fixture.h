#pragma once
// Meshes built, uploaded and traced by the kernel intersect_test.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "engine/scene/gpu_scene.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/ray_sets.h"

inline constexpr uint32_t NO_HIT = 0x7fffffff; // as the kernel packs it
inline constexpr float FAR = std::numeric_limits<float>::max();

struct Hit {
    uint32_t packed = 0;
    float u = 0, v = 0, t = 0;
    uint32_t triangle() const { return packed & 0x7fffffffu; }
    bool isHit() const { return triangle() != NO_HIT; }
    bool occluded() const { return packed >> 31 != 0; }
    bool operator==(const Hit&) const = default;
};

struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<scene::Triangle> triangles;
    std::vector<uint8_t> needsAlphaTest; // empty: none
    std::vector<uint32_t> solid = {1};   // per triangle

    void add(glm::vec3 a, glm::vec3 b, glm::vec3 c)
    {
        const uint32_t first = uint32_t(positions.size());
        positions.insert(positions.end(), {a, b, c});
        triangles.push_back({.vertices = {first, first + 1, first + 2}});
    }
};

class Intersect : public GpuTest
{
  protected:
    std::optional<scene::TraversalStack> forcedStack; // instead of the one that fits device and tree
    std::vector<gpu::Constant> constants;             // of the kernel, beside those that every trace() has

    static scene::BvhInput inputOf(const Mesh& mesh)
    {
        return {.positions = mesh.positions, .triangles = mesh.triangles, .needsAlphaTest = mesh.needsAlphaTest};
    }
    std::vector<Hit> trace(const Mesh& mesh, const std::vector<TestRay>& rays)
    {
        return trace(mesh, scene::buildBvh(inputOf(mesh), device().limits().tableBytes), rays);
    }
    std::vector<Hit> trace(const Mesh& mesh, const scene::Bvh& bvh, const std::vector<TestRay>& rays)
    {
        const scene::TraversalStack stack = forcedStack.value_or(scene::traversalStack(device().adapter(), bvh.stats));
        const gpu::Buffer nodes = upload("nodes", bvh.nodes, gpu::Usage::Table);
        const gpu::Buffer triangles = upload("triangles", bvh.triangles, gpu::Usage::Table);
        const gpu::Buffer rayBuffer = upload("rays", rays);
        std::vector<uint32_t> solidWords = mesh.solid;
        solidWords.resize(std::max<size_t>(solidWords.size(), 4));
        const gpu::Buffer solid = upload("solid", solidWords);
        const gpu::Buffer hits = create<Hit>("hits", rays.size());
        std::vector<gpu::Constant> all = constants;
        all.insert(all.end(), {{"HAS_ALPHA", mesh.needsAlphaTest.empty() ? 0u : 1u},
                               {"STACK_SIZE", stack.entries},
                               {"STACK_IN_REGISTERS", stack.inRegisters ? 1u : 0u}});
        run({.shader = TEST_SPIRV_DIR "/intersect_test",
             .constants = all,
             .buffers = {{"Nodes", &nodes},
                         {"Triangles", &triangles},
                         {"Rays", &rayBuffer},
                         {"Solid", &solid},
                         {"Hits", &hits}},
             .threads = {uint32_t(rays.size())}});
        return download<Hit>(hits);
    }
};
