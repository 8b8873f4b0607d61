#pragma once
// The stages between triangles and tables: pairs of triangles, Embree's binary tree over them, then an 8-wide one.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/bvh.h"

namespace scene
{

constexpr uint32_t BVH_WIDTH = 8;
constexpr uint32_t BVH_LEAF_PAIRS = 3;
constexpr uint32_t BVH_MAX_BINARY_DEPTH =
    3 * 31; // collapsing by height takes three levels at once: fits BVH_STACK_SIZE
constexpr float BVH_NODE_COST = 1.0f;
constexpr float BVH_PAIR_COST = 0.7f; // measured on lavapipe, tests/bench/LOG.md

// Two triangles with a common edge, or one. The edge is that of vertices turn + 1 and turn + 2 (mod 3) of each.
struct TrianglePair {
    uint32_t first = 0;
    uint32_t second = NONE;
    uint32_t firstTurn = 0;
    uint32_t secondTurn = 0;
};

struct BinaryNode {
    Box box;
    uint32_t left = 0;     // leaf: the pair's index
    uint32_t right = NONE; // leaf: NONE

    bool isLeaf() const { return right == NONE; }
};
using BinaryTree = std::vector<BinaryNode>; // children before parents, the root last; empty: no pair

struct WideChild {
    enum class Kind : uint8_t { Empty, Node, Leaf };
    Kind kind = Kind::Empty;
    uint8_t count = 0;  // leaf: of pairs
    uint32_t first = 0; // leaf: into WideTree::pairs; node: into WideTree::nodes
    Box box;
};

struct WideNode {
    std::array<WideChild, BVH_WIDTH> slots;
};

struct WideTree {
    std::vector<WideNode> nodes; // the root first; the child nodes of one node contiguous, in order of slots
    std::vector<uint32_t> pairs; // indices; those of one node contiguous, in order of slots
    uint32_t levels = 0;
};

using Corners = std::array<glm::vec3, 3>;
Corners cornersOf(const BvhInput& input, uint32_t triangle);
Box boxOf(const BvhInput& input, const TrianglePair& pair);

// Embree's tree over pairs of triangles, or over boxes. Spatial splits name a pair several times. Throws Error.
BinaryTree buildBinaryTree(const BvhInput& input, std::span<const TrianglePair> pairs, bool spatialSplits);
BinaryTree buildBinaryTree(std::span<const Box> boxes);

// Puts triangles together whose common box is smaller than both of theirs: half the records, three quarters of the
// nodes, and a test of both has less to do than two. `usable`: those to be in the tree; each is in one pair.
// Alpha-tested ones stay alone. `edges`: which ones are common, those between equal positions, or only those between
// the same vertices, which stay common while they move.
enum class Edges { OfPositions, OfVertices };
std::vector<TrianglePair> pairTriangles(const BvhInput& input, std::span<const uint32_t> usable,
                                        Edges edges = Edges::OfPositions);

// Makes a pair across a common edge of vertices that of another pose: where a transform mirrors, vertices 1 and 2 have
// changed places; a triangle without area names one vertex three times and is left out, for nothing meets it. False:
// both have an area but no such edge any more.
bool follow(TrianglePair& pair, const BvhInput& input);

// Bittner, Hapala and Havran, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies", 2013: puts large
// nodes where they enlarge the tree least. At most BVH_MAX_BINARY_DEPTH deep if the given tree was.
BinaryTree reinsert(BinaryTree tree);

// Ylitie et al. 2017, Section 3.1: the set of binary nodes that gives the cheapest wide tree by the surface area
// heuristic.
WideTree collapse(const BinaryTree& tree);

// Fits the boxes of these nodes, children before parents, to where the pairs' triangles are.
void refit(WideTree& tree, std::span<const uint32_t> nodes, std::span<const TrianglePair> pairs, const BvhInput& input);

// Expected cost of a ray through the root's box; 0 where that has no area.
double sahCost(const WideTree& tree);

// Where the nodes lie in their table: the child in slot s of node n at row first[n] + s, so that traversal keeps one
// word a stack entry and counts no bits. Other nodes' children fill the gaps.
struct NodeLayout {
    std::vector<uint32_t> row;   // per node; the root's is 0
    std::vector<uint32_t> first; // per node
    uint32_t rows = 0;           // of the table, gaps included
};
NodeLayout layOut(const WideTree& tree);

// Bit 24+s: slot s is a node; bit 3s+k: slot s is a leaf with a k-th pair.
uint32_t masksOf(const WideNode& node);

// The largest coordinate of the tree's boxes: by a part of it all boxes grow, so that rounding loses no hit.
float magnitudeOf(const WideTree& tree);

// The table "Nodes"; `magnitude`: at least the tree's.
std::vector<glm::uvec4> encodeNodes(const WideTree& tree, const NodeLayout& layout, float magnitude);
void encodeNode(const WideTree& tree, const NodeLayout& layout, float magnitude, uint32_t node,
                std::span<glm::uvec4> table);

// The table "Triangles".
std::vector<glm::uvec4> encodeTriangles(const WideTree& tree, std::span<const TrianglePair> pairs,
                                        const BvhInput& input);
void encodeRecord(const WideTree& tree, std::span<const TrianglePair> pairs, const BvhInput& input, uint32_t record,
                  std::span<glm::uvec4> table);

} // namespace scene
