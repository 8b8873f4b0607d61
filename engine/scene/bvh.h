#pragma once
// Embree's builder, flattened into tables for traversal in compute shaders (shaders/scene/intersect.glsl). The tables'
// layout: shaders/shared/bvh.h.

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/scene.h"

namespace scene
{

struct Box {
    glm::vec3 lower = glm::vec3(std::numeric_limits<float>::infinity());
    glm::vec3 upper = glm::vec3(-std::numeric_limits<float>::infinity());

    void extend(const Box& other)
    {
        lower = glm::min(lower, other.lower);
        upper = glm::max(upper, other.upper);
    }
    float halfArea() const
    {
        const glm::vec3 size = upper - lower;
        return size.x * size.y + size.y * size.z + size.z * size.x;
    }
    glm::vec3 center() const { return 0.5f * lower + 0.5f * upper; }
};

struct BvhStats {
    uint64_t nodes = 0;
    uint64_t triangleRecords = 0;  // with duplicates of spatial splits
    uint64_t skippedTriangles = 0; // degenerate or non-finite
    uint64_t bytes = 0;
    double sahCost = 0;      // expected cost of a random ray through the scene's box, in node visits
    double buildSeconds = 0; // that the tree took, not its refitting
    uint32_t depth = 0;      // largest number of stack entries that traversal can need, at most shared::BVH_STACK_SIZE
};

struct Bvh {
    std::vector<glm::uvec4> nodes;     // table "Nodes"
    std::vector<glm::uvec4> triangles; // table "Triangles"
    BvhStats stats;
};

struct BvhInput {
    std::span<const glm::vec3> positions;
    std::span<const Triangle> triangles;
    std::span<const uint8_t> needsAlphaTest; // per triangle, 0 or 1; empty: none does
    std::function<void(double)> progress;    // fraction done in [0,1], from one thread at a time; may be empty
};

// Degenerate and non-finite triangles are left out. No triangle at all gives a tree that nothing hits.
// Throws Error when the tree cannot fit `maxTableBytes`, for each of the two tables.
Bvh buildBvh(const BvhInput& input, uint64_t maxTableBytes);

// Whole nodes of a tree that lies behind others, whose nodes and records are that many.
std::vector<glm::uvec4> movedNodes(std::span<const glm::uvec4> rows, uint32_t nodes, uint32_t records);

// A tree over boxes, with one record for each: record i is that of boxes[order[i]].
struct BoxTree {
    std::vector<glm::uvec4> nodes; // table "Nodes"
    std::vector<uint32_t> order;
};
BoxTree buildBoxTree(std::span<const Box> boxes); // none: a tree that nothing meets
uint32_t roomForNodesOver(size_t boxes);          // rows of table "Nodes": more than such trees were seen to need

// Rows of a table, from `first` up to `end`.
struct RowRange {
    uint32_t first = 0, end = 0;
};

// The rows of items of so many rows each, in ascending order; together where they are near each other.
std::vector<RowRange> rangesOf(std::span<const uint32_t> items, uint32_t stride);

// Of triangles that move. Its boxes are refitted to where they are; it is built anew once that has made it half as
// expensive again as it was. Which hits traversal finds does not depend on it. Triangles without area stay in it, for
// they may have some later: nothing meets them.
class MovingBvh
{
  public:
    // `moves`: 0 or 1 for each triangle, empty for 1; the others are where they are at rest in all poses. Throws Error
    // like buildBvh().
    MovingBvh(const BvhInput& rest, uint64_t maxTableBytes, std::vector<uint8_t> moves = {});
    MovingBvh(const MovingBvh& other);
    MovingBvh& operator=(const MovingBvh&) = delete;
    ~MovingBvh();

    // With the triangles, counted as at rest, where `input` has them. Until the next call.
    const Bvh& at(const BvhInput& input);
    // While the version stays, what at() gives differs from pose to pose in these rows alone.
    struct Changes {
        uint64_t version = 0;
        std::vector<RowRange> nodes, triangles;
    };
    const Changes& changes() const;
    // The most of a pose: rows of both tables, and BvhStats::depth.
    struct Most {
        uint32_t nodeRows = 0, recordRows = 0, depth = 0;
    };
    const Most& most() const;

  private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

} // namespace scene
