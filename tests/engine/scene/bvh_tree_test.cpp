// Covers engine/scene/bvh_collapse.cpp, engine/scene/bvh_encode.cpp, engine/scene/bvh_layout.cpp,
// engine/scene/bvh_pairs.cpp, engine/scene/bvh_reinsert.cpp.

#include "engine/scene/bvh_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>

#include <gtest/gtest.h>

#include "shaders/shared/bvh.h"
#include "tests/support/random_points.h"

namespace
{

using scene::Box;

// A spine whose every node also carries a bush of boxes larger than the rest of the spine: opening the bush pays more
// than going down the spine, so that the cheapest wide tree is as deep as the spine.
TEST(BvhCollapse, BoundsTheDepthOfADegenerateTree)
{
    constexpr uint32_t BUSH_LEVELS = 7;
    scene::BinaryTree tree;
    const auto bush = [&](auto& self, const Box& box, uint32_t levels) -> uint32_t {
        const uint32_t left = levels == 0 ? uint32_t(tree.size()) : self(self, box, levels - 1);
        const uint32_t right = levels == 0 ? scene::NONE : self(self, box, levels - 1);
        tree.push_back({.box = box, .left = left, .right = right});
        return uint32_t(tree.size() - 1);
    };
    uint32_t spine = bush(bush, {glm::vec3(0), glm::vec3(1e-9f)}, BUSH_LEVELS);
    const uint32_t spineLevels = scene::BVH_MAX_BINARY_DEPTH - BUSH_LEVELS;
    for (uint32_t level = 1; level <= spineLevels; ++level) {
        const Box box = {glm::vec3(0), glm::vec3(1e-9f * std::pow(1.5f, float(level)))};
        const uint32_t left = bush(bush, box, BUSH_LEVELS);
        tree.push_back({.box = box, .left = left, .right = spine});
        spine = uint32_t(tree.size() - 1);
    }
    const scene::WideTree wide = scene::collapse(tree);
    EXPECT_EQ(wide.pairs.size(), (spineLevels + 1) << BUSH_LEVELS);
    EXPECT_LE(wide.levels, shared::BVH_STACK_SIZE);
}

// The dynamic program must beat every other way to choose wide nodes from the same binary tree.
TEST(BvhCollapse, IsNoDearerThanRandomCollapses)
{
    Random random(11);
    scene::BinaryTree tree;
    const auto grow = [&](auto& self, Box box, uint32_t leaves) -> uint32_t {
        if (leaves == 1) {
            tree.push_back({.box = box, .left = uint32_t(tree.size())});
            return uint32_t(tree.size() - 1);
        }
        const int axis = int(random.between(0, 2.999f));
        const float at = glm::mix(box.lower[axis], box.upper[axis], random.between(0.1f, 0.9f));
        Box low = box, high = box;
        low.upper[axis] = high.lower[axis] = at;
        const uint32_t half = 1 + uint32_t(random.between(0, float(leaves - 1) - 0.01f));
        const uint32_t left = self(self, low, half);
        const uint32_t right = self(self, high, leaves - half);
        tree.push_back({.box = box, .left = left, .right = right});
        return uint32_t(tree.size() - 1);
    };
    const uint32_t root = grow(grow, {glm::vec3(0), glm::vec3(1)}, 60);

    // The cost of collapsing by opening random children, in units of area as sahCost has it before division.
    const auto leavesUnder = [&](auto& self, uint32_t node) -> uint32_t {
        return tree[node].isLeaf() ? 1 : self(self, tree[node].left) + self(self, tree[node].right);
    };
    const auto randomCost = [&](auto& self, uint32_t node) -> double {
        double cost = scene::BVH_NODE_COST * tree[node].box.halfArea();
        std::vector<uint32_t> roots = {tree[node].left, tree[node].right};
        while (roots.size() < 8) {
            std::vector<size_t> open;
            for (size_t i = 0; i < roots.size(); ++i)
                if (!tree[roots[i]].isLeaf()) open.push_back(i);
            if (open.empty()) break;
            const size_t pick = open[size_t(random.between(0, float(open.size()) - 0.01f))];
            roots.push_back(tree[roots[pick]].right);
            roots[pick] = tree[roots[pick]].left;
        }
        for (const uint32_t child : roots) {
            const uint32_t leaves = leavesUnder(leavesUnder, child);
            const double asLeaf = scene::BVH_PAIR_COST * double(leaves) * tree[child].box.halfArea();
            if (tree[child].isLeaf())
                cost += asLeaf;
            else if (leaves <= 3)
                cost += std::min(asLeaf, self(self, child));
            else
                cost += self(self, child);
        }
        return cost;
    };
    const double best = scene::sahCost(scene::collapse(tree)) * tree[root].box.halfArea();
    double cheapest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 20000; ++i) cheapest = std::min(cheapest, randomCost(randomCost, root));
    EXPECT_LE(best, cheapest * (1 + 1e-6));
    EXPECT_GT(best, 0.5 * cheapest) << "the costs do not mean the same";
}

// A balanced tree over leaves as they come, which is bad when they come in random order.
scene::BinaryTree balanced(const std::vector<Box>& leaves)
{
    scene::BinaryTree tree;
    const auto grow = [&](auto& self, size_t begin, size_t end) -> uint32_t {
        scene::BinaryNode node = {.box = leaves[begin], .left = uint32_t(begin)};
        if (end - begin > 1) {
            node.left = self(self, begin, (begin + end) / 2);
            node.right = self(self, (begin + end) / 2, end);
            node.box = tree[node.left].box;
            node.box.extend(tree[node.right].box);
        }
        tree.push_back(node);
        return uint32_t(tree.size() - 1);
    };
    grow(grow, 0, leaves.size());
    return tree;
}

TEST(BvhReinsert, KeepsLeavesFitsBoxesAndMakesTheTreeSmaller)
{
    Random random(13);
    std::vector<Box> leaves;
    for (int i = 0; i < 2000; ++i) {
        const glm::vec3 corner = random.point(1.0f);
        leaves.push_back({corner, corner + glm::vec3(random.between(0, 0.02f))});
    }
    const scene::BinaryTree before = balanced(leaves);
    const scene::BinaryTree after = scene::reinsert(before);
    ASSERT_EQ(after.size(), before.size());
    std::set<uint32_t> seenLeaves, seenChildren;
    double areaBefore = 0, areaAfter = 0;
    for (uint32_t i = 0; i < after.size(); ++i) {
        const scene::BinaryNode& node = after[i];
        areaBefore += double(before[i].box.halfArea());
        areaAfter += double(node.box.halfArea());
        Box expected = leaves[0];
        if (node.isLeaf()) {
            EXPECT_TRUE(seenLeaves.insert(node.left).second);
            expected = leaves.at(node.left);
        } else {
            ASSERT_LT(std::max(node.left, node.right), i) << "children come before parents";
            EXPECT_TRUE(seenChildren.insert(node.left).second && seenChildren.insert(node.right).second);
            expected = after[node.left].box;
            expected.extend(after[node.right].box);
        }
        EXPECT_TRUE(node.box.lower == expected.lower && node.box.upper == expected.upper);
    }
    EXPECT_EQ(seenLeaves.size(), leaves.size());
    EXPECT_EQ(seenChildren.size(), after.size() - 1);
    EXPECT_LT(areaAfter, 0.96 * areaBefore);
}

// Boxes within boxes: the smallest tree is a chain, longer than what the stack holds.
TEST(BvhReinsert, LeavesATreeThatWouldGetTooDeep)
{
    std::vector<Box> leaves;
    for (int i = 0; i < 2000; ++i) leaves.push_back({glm::vec3(0), glm::vec3(std::pow(1.03f, float(i - 1000)))});
    std::shuffle(leaves.begin(), leaves.end(), std::mt19937(3));
    const scene::BinaryTree before = balanced(leaves);
    const scene::BinaryTree after = scene::reinsert(before);
    std::vector<uint32_t> heights;
    for (const scene::BinaryNode& node : after)
        heights.push_back(node.isLeaf() ? 0 : 1 + std::max(heights[node.left], heights[node.right]));
    EXPECT_LE(heights.back(), scene::BVH_MAX_BINARY_DEPTH);
}

// Boxes are those of what is below, in every node, wherever the triangles have gone.
TEST(BvhRefit, FitsEveryBoxToWhatItHolds)
{
    constexpr uint32_t COUNT = 3000;
    Random random(17);
    std::vector<glm::vec3> positions;
    std::vector<scene::Triangle> triangles;
    std::vector<scene::TrianglePair> pairs;
    const auto place = [&](float size) {
        positions.clear();
        for (uint32_t i = 0; i < COUNT; ++i) {
            const glm::vec3 center = random.point(1.0f);
            for (int corner = 0; corner < 4; ++corner) positions.push_back(center + random.point(size));
        }
    };
    place(0.01f);
    for (uint32_t i = 0; i < COUNT; ++i) {
        triangles.push_back({.vertices = {4 * i, 4 * i + 1, 4 * i + 2}});
        triangles.push_back({.vertices = {4 * i + 1, 4 * i, 4 * i + 3}});
        pairs.push_back(
            {.first = 2 * i, .second = i % 3 == 0 ? scene::NONE : 2 * i + 1, .firstTurn = 2, .secondTurn = 2});
    }
    const scene::BvhInput input = {.positions = positions, .triangles = triangles};
    std::vector<Box> leaves;
    for (const scene::TrianglePair& pair : pairs) leaves.push_back(scene::boxOf(input, pair));
    scene::WideTree tree = scene::collapse(balanced(leaves));

    place(0.3f);
    std::vector<uint32_t> nodes(tree.nodes.size());
    std::iota(nodes.rbegin(), nodes.rend(), 0u); // children follow their parents
    scene::refit(tree, nodes, pairs, {.positions = positions, .triangles = triangles});
    size_t pairCount = 0;
    const auto boxBelow = [&](auto& self, uint32_t node) -> Box {
        Box all;
        for (const scene::WideChild& child : tree.nodes[node].slots) {
            Box expected;
            if (child.kind == scene::WideChild::Kind::Empty) continue;
            if (child.kind == scene::WideChild::Kind::Node) expected = self(self, child.first);
            for (uint32_t i = 0; i < child.count; ++i, ++pairCount) {
                const scene::TrianglePair& pair = pairs[tree.pairs[child.first + i]];
                for (const uint32_t triangle : {pair.first, pair.second})
                    for (size_t k = 0; triangle != scene::NONE && k < 3; ++k)
                        expected.extend(
                            {positions[triangles[triangle].vertices[k]], positions[triangles[triangle].vertices[k]]});
            }
            EXPECT_TRUE(child.box.lower == expected.lower && child.box.upper == expected.upper) << node;
            all.extend(expected);
        }
        return all;
    };
    boxBelow(boxBelow, 0);
    EXPECT_EQ(pairCount, COUNT);
}

// All ways to fold what has no area cost rays nothing, but not all take as few nodes.
TEST(BvhCollapse, OfPointsIsSmallAndFlat)
{
    constexpr uint32_t COUNT = 4096;
    std::vector<Box> leaves(COUNT, Box{glm::vec3(1), glm::vec3(1)});
    const scene::WideTree points = scene::collapse(balanced(leaves));
    EXPECT_EQ(points.pairs.size(), COUNT);
    EXPECT_LE(points.nodes.size(), COUNT / 8);
    EXPECT_LE(points.levels, 6u);
    EXPECT_EQ(scene::sahCost(points), 0);
    leaves.front() = {glm::vec3(0), glm::vec3(1)}; // in a scene that has an area
    const scene::WideTree among = scene::collapse(balanced(leaves));
    EXPECT_LE(among.nodes.size(), COUNT / 8);
    EXPECT_LE(among.levels, 6u);
    EXPECT_GT(scene::sahCost(among), 0);
}

// Vertices 0 1 2 and 1 0 3 about edge 0-1, each triangle turned so that it begins anywhere.
TEST(BvhPairs, FollowMirroringAndCollapse)
{
    for (uint32_t turns = 0; turns < 9; ++turns) {
        const uint32_t one = turns % 3, two = turns / 3;
        const std::array<uint32_t, 3> a = {2, 0, 1}, b = {3, 1, 0}; // the vertex of its own first
        const auto turned = [](const std::array<uint32_t, 3>& v, uint32_t turn) {
            scene::Triangle triangle;
            for (uint32_t i = 0; i < 3; ++i) triangle.vertices[(turn + i) % 3] = v[i];
            return triangle;
        };
        const std::vector<scene::Triangle> rest = {turned(a, one), turned(b, two)};
        const scene::TrianglePair pair = {.first = 0, .second = 1, .firstTurn = one, .secondTurn = two};
        const auto followed = [&](std::vector<scene::Triangle> triangles) -> std::optional<scene::TrianglePair> {
            scene::TrianglePair p = pair;
            if (!scene::follow(p, {.triangles = triangles})) return std::nullopt;
            if (p.second != scene::NONE && triangles[0].vertices[0] != triangles[0].vertices[1]) {
                EXPECT_EQ(triangles[p.first].vertices[p.firstTurn], 2u) << "not the vertex of its own";
                EXPECT_EQ(triangles[p.second].vertices[p.secondTurn], 3u) << "not the vertex of its own";
            }
            return p;
        };
        const auto mirrored = [](scene::Triangle triangle) {
            std::swap(triangle.vertices[1], triangle.vertices[2]);
            return triangle;
        };
        const auto point = [](scene::Triangle triangle) {
            triangle.vertices.fill(triangle.vertices[0]);
            return triangle;
        };
        EXPECT_EQ(followed(rest)->second, 1u);
        EXPECT_EQ(followed({mirrored(rest[0]), mirrored(rest[1])})->second, 1u);
        EXPECT_EQ(followed({rest[0], point(rest[1])})->second, scene::NONE);
        EXPECT_EQ(followed({rest[0], point(rest[1])})->first, 0u);
        EXPECT_EQ(followed({point(rest[0]), rest[1]})->first, 1u);
        EXPECT_EQ(followed({point(rest[0]), mirrored(rest[1])})->first, 1u);
        EXPECT_TRUE(followed({point(rest[0]), point(rest[1])}));
        EXPECT_FALSE(followed({mirrored(rest[0]), rest[1]}));
        EXPECT_FALSE(followed({rest[0], mirrored(rest[1])}));
    }
}

} // namespace
