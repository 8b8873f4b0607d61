#include "engine/scene/bvh.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/clock.h"
#include "engine/base/error.h"
#include "engine/scene/bvh_tree.h"
#include "shaders/shared/bvh.h"

namespace scene
{

namespace
{

// Coordinates beyond this count as non-finite: Embree drops them, and areas would overflow.
constexpr float LARGEST_COORDINATE = 1e18f;
bool isUsable(const Corners& v)
{
    for (const glm::vec3& corner : v)
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(corner[axis]) <= LARGEST_COORDINATE)) return false;
    const glm::dvec3 normal = glm::cross(glm::dvec3(v[1]) - glm::dvec3(v[0]), glm::dvec3(v[2]) - glm::dvec3(v[0]));
    return glm::dot(normal, normal) > 0.0;
}

std::vector<uint32_t> usableTriangles(const BvhInput& input)
{
    std::vector<uint32_t> usable;
    usable.reserve(input.triangles.size());
    for (uint32_t i = 0; i < input.triangles.size(); ++i)
        if (isUsable(cornersOf(input, i))) usable.push_back(i);
    return usable;
}

uint64_t bytesOf(uint64_t rows, uint32_t stride)
{
    return rows * stride * sizeof(glm::uvec4);
}

void requireFits(const char* what, uint64_t rows, uint32_t stride, uint64_t limit)
{
    if (bytesOf(rows, stride) > limit)
        throw Error(
            "The scene's {} {} need a table of {} bytes, more than the {} that this device allows: simplify the "
            "scene, or choose another device with --device.",
            rows, what, bytesOf(rows, stride), limit);
}

void requireValid(const BvhInput& input)
{
    CHECK(input.needsAlphaTest.empty() || input.needsAlphaTest.size() == input.triangles.size());
    CHECK_LT(input.triangles.size(), size_t{shared::BVH_ALPHA_FLAG});
}

Bvh tablesOf(const WideTree& tree, const NodeLayout& layout, float magnitude, std::span<const TrianglePair> pairs,
             const BvhInput& input)
{
    Bvh bvh;
    bvh.nodes = encodeNodes(tree, layout, magnitude);
    bvh.triangles = encodeTriangles(tree, pairs, input);
    bvh.stats.nodes = tree.nodes.size();
    bvh.stats.triangleRecords = tree.pairs.size();
    bvh.stats.bytes = (bvh.nodes.size() + bvh.triangles.size()) * sizeof(glm::uvec4);
    bvh.stats.sahCost = sahCost(tree);
    bvh.stats.depth = tree.levels;
    return bvh;
}

} // namespace

Corners cornersOf(const BvhInput& input, uint32_t triangle)
{
    const auto& vertices = input.triangles[triangle].vertices;
    return {input.positions[vertices[0]], input.positions[vertices[1]], input.positions[vertices[2]]};
}

Box boxOf(const BvhInput& input, const TrianglePair& pair)
{
    Box box;
    for (const glm::vec3& corner : cornersOf(input, pair.first)) box.extend({corner, corner});
    if (pair.second != NONE)
        for (const glm::vec3& corner : cornersOf(input, pair.second)) box.extend({corner, corner});
    return box;
}

Bvh buildBvh(const BvhInput& input, uint64_t maxTableBytes)
{
    requireValid(input);
    const auto start = Clock::now();

    const std::vector<uint32_t> usable = usableTriangles(input);
    const std::vector<TrianglePair> pairs = pairTriangles(input, usable);
    // A pair has at least one record: do not begin what cannot end well.
    requireFits("pairs of triangles", pairs.size(), shared::BVH_RECORD_STRIDE, maxTableBytes);
    WideTree tree = collapse(reinsert(buildBinaryTree(input, pairs, true)));
    if (bytesOf(tree.pairs.size(), shared::BVH_RECORD_STRIDE) > maxTableBytes)
        tree = collapse(reinsert(buildBinaryTree(input, pairs, false)));
    requireFits("pairs of triangles", tree.pairs.size(), shared::BVH_RECORD_STRIDE, maxTableBytes);
    const NodeLayout layout = layOut(tree);
    requireFits("tree nodes", layout.rows, shared::BVH_NODE_STRIDE,
                std::min(maxTableBytes, bytesOf(shared::BVH_MAX_NODES, shared::BVH_NODE_STRIDE)));

    Bvh bvh = tablesOf(tree, layout, magnitudeOf(tree), pairs, input);
    bvh.stats.skippedTriangles = input.triangles.size() - usable.size();
    bvh.stats.buildSeconds = secondsSince(start);
    if (input.progress) input.progress(1.0);
    return bvh;
}

std::vector<glm::uvec4> movedNodes(std::span<const glm::uvec4> rows, uint32_t nodes, uint32_t records)
{
    std::vector<glm::uvec4> copy(rows.begin(), rows.end());
    for (size_t i = 1; i < copy.size(); i += shared::BVH_NODE_STRIDE) {
        copy[i].y += nodes << 8;
        copy[i].z += records;
    }
    return copy;
}

BoxTree buildBoxTree(std::span<const Box> boxes)
{
    WideTree tree = collapse(buildBinaryTree(boxes));
    return {.nodes = encodeNodes(tree, layOut(tree), magnitudeOf(tree)), .order = std::move(tree.pairs)};
}

uint32_t roomForNodesOver(size_t boxes)
{
    // Most have more than two children, and the layout has few gaps.
    return uint32_t(2 * std::max<size_t>(boxes, 1) + 64) * shared::BVH_NODE_STRIDE;
}

std::vector<RowRange> rangesOf(std::span<const uint32_t> items, uint32_t stride)
{
    constexpr uint32_t GAP = 64; // rows between two of them that are rather copied, too
    std::vector<RowRange> ranges;
    for (const uint32_t item : items) {
        const uint32_t first = item * stride;
        if (ranges.empty() || first > ranges.back().end + GAP) ranges.push_back({first, first});
        ranges.back().end = std::max(ranges.back().end, first + stride);
    }
    return ranges;
}

struct MovingBvh::Tree {
    std::vector<uint8_t> moves;      // by triangle
    std::vector<TrianglePair> pairs; // as they were paired
    std::vector<TrianglePair> posed; // as the last pose has them
    WideTree wide;
    NodeLayout layout;
    double builtCost = 0, buildSeconds = 0;
    float magnitude = 0; // with which it is encoded
    Most most;
    // What follows the triangles that move.
    std::vector<uint32_t> movingPairs, movingRecords;
    std::vector<uint32_t> movingNodes; // children before parents
    Bvh tables;
    Changes changes;

    void pair(const BvhInput& input)
    {
        std::vector<uint32_t> all(input.triangles.size());
        std::iota(all.begin(), all.end(), 0u);
        posed = pairs = pairTriangles(input, all, Edges::OfVertices);
    }
    void build(const BvhInput& input)
    {
        const auto start = Clock::now();
        wide = collapse(reinsert(buildBinaryTree(input, posed, false)));
        layout = layOut(wide);
        builtCost = sahCost(wide);
        findWhatMoves();
        buildSeconds = secondsSince(start);
    }
    void findWhatMoves()
    {
        movingPairs.clear();
        std::vector<bool> moving(pairs.size());
        for (uint32_t i = 0; i < pairs.size(); ++i) {
            moving[i] = moves[pairs[i].first] || (pairs[i].second != NONE && moves[pairs[i].second]);
            if (moving[i]) movingPairs.push_back(i);
        }
        movingRecords.clear();
        for (uint32_t i = 0; i < wide.pairs.size(); ++i)
            if (moving[wide.pairs[i]]) movingRecords.push_back(i);
        std::vector<bool> nodes(wide.nodes.size());
        movingNodes.clear();
        for (auto n = uint32_t(wide.nodes.size()); n-- > 0;) { // children follow their parents
            for (const WideChild& child : wide.nodes[n].slots) {
                if (child.kind == WideChild::Kind::Node) nodes[n] = nodes[n] || nodes[child.first];
                for (uint32_t i = 0; child.kind == WideChild::Kind::Leaf && i < child.count; ++i)
                    nodes[n] = nodes[n] || moving[wide.pairs[child.first + i]];
            }
            if (nodes[n]) movingNodes.push_back(n);
        }
        std::vector<uint32_t> rows;
        for (const uint32_t n : movingNodes) rows.push_back(layout.row[n]);
        std::ranges::sort(rows);
        changes.nodes = rangesOf(rows, shared::BVH_NODE_STRIDE);
        changes.triangles = rangesOf(movingRecords, shared::BVH_RECORD_STRIDE);
    }
    // False: the pairs do not hold any more.
    bool follow(const BvhInput& input)
    {
        for (const uint32_t i : movingPairs) {
            TrianglePair pair = pairs[i];
            if (!scene::follow(pair, input)) return false;
            posed[i] = pair;
        }
        return true;
    }
    // Everything, with room for boxes that grow somewhat.
    void encodeAll(const BvhInput& input)
    {
        magnitude = 1.25f * magnitudeOf(wide);
        tables = tablesOf(wide, layout, magnitude, posed, input);
        ++changes.version;
    }
    void encodeMoving(const BvhInput& input)
    {
        for (const uint32_t n : movingNodes) encodeNode(wide, layout, magnitude, n, tables.nodes);
        for (const uint32_t record : movingRecords) encodeRecord(wide, posed, input, record, tables.triangles);
        tables.stats.sahCost = sahCost(wide);
    }
    uint32_t nodeRows() const { return layout.rows * shared::BVH_NODE_STRIDE; }
};

MovingBvh::MovingBvh(const BvhInput& rest, uint64_t maxTableBytes, std::vector<uint8_t> moves)
    : tree_(std::make_unique<Tree>())
{
    requireValid(rest);
    if (moves.empty()) moves.assign(rest.triangles.size(), 1);
    CHECK_EQ(moves.size(), rest.triangles.size());
    const uint64_t count = std::max<uint64_t>(rest.triangles.size(), 1); // of pairs, where no edge stays common
    requireFits("triangles", count, shared::BVH_RECORD_STRIDE, maxTableBytes);
    Tree& tree = *tree_;
    tree.moves = std::move(moves);
    tree.pair(rest);
    tree.build(rest);
    const uint64_t nodes = 2 * uint64_t{tree.layout.rows} * count / std::max<size_t>(tree.pairs.size(), 1);
    requireFits("tree nodes", nodes, shared::BVH_NODE_STRIDE,
                std::min(maxTableBytes, bytesOf(shared::BVH_MAX_NODES / 2, shared::BVH_NODE_STRIDE))); // of two worlds
    tree.most = {.nodeRows = uint32_t(nodes) * shared::BVH_NODE_STRIDE,
                 .recordRows = uint32_t(count) * shared::BVH_RECORD_STRIDE,
                 .depth = std::min(tree.wide.levels + 4, shared::BVH_STACK_SIZE)};
    tree.encodeAll(rest);
    if (rest.progress) rest.progress(1.0);
}

MovingBvh::MovingBvh(const MovingBvh& other) : tree_(std::make_unique<Tree>(*other.tree_)) {}

MovingBvh::~MovingBvh() = default;

const Bvh& MovingBvh::at(const BvhInput& input)
{
    constexpr double WORN = 1.5;
    Tree& tree = *tree_;
    const bool torn = !tree.follow(input);
    if (!torn) refit(tree.wide, tree.movingNodes, tree.posed, input);
    bool isNew = false;
    if (torn || sahCost(tree.wide) > WORN * tree.builtCost) {
        Tree fresh = tree;
        if (torn) fresh.pair(input);
        fresh.build(input);
        isNew = fresh.nodeRows() <= fresh.most.nodeRows && fresh.wide.levels <= fresh.most.depth;
        if (isNew)
            tree = std::move(fresh);
        else if (torn)
            throw Error("A pose of the scene needs a deeper tree of boxes than it has room for.");
        else
            tree.builtCost = sahCost(tree.wide); // go on with this one
    }
    if (isNew || magnitudeOf(tree.wide) > tree.magnitude)
        tree.encodeAll(input);
    else
        tree.encodeMoving(input);
    tree.tables.stats.buildSeconds = tree.buildSeconds;
    return tree.tables;
}

const MovingBvh::Changes& MovingBvh::changes() const
{
    return tree_->changes;
}

const MovingBvh::Most& MovingBvh::most() const
{
    return tree_->most;
}

} // namespace scene
