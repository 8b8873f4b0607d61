#include "engine/scene/bvh_tree.h"

#include <algorithm>
#include <numeric>

#include "engine/base/check.h"
#include "shaders/shared/bvh.h"

namespace scene
{

namespace
{

// What is best for one binary node: cost[i-1] of its pairs when it may become at most i roots of wide subtrees.
struct Plan {
    std::array<float, BVH_WIDTH - 1> cost = {};
    std::array<uint8_t, BVH_WIDTH - 1> left =
        {}; // [i-2]: of i roots, those left of the split; 0: i-1 roots are as good
    uint32_t pairs = 1;
    uint32_t height = 0;
    bool leaf = true; // as one root: a leaf
};

using Roots = std::vector<uint32_t>; // binary nodes

// Of the whole tree's: what smaller nodes count with, too, so that what has no area for now gets as few nodes as may
// be, and not just any.
constexpr float LEAST_AREA = 1e-12f;

class Collapser
{
  public:
    explicit Collapser(const BinaryTree& tree) : tree_(tree), plans_(tree.size())
    {
        const float area = tree.empty() ? 0 : tree.back().box.halfArea();
        leastArea_ = area > 0 ? LEAST_AREA * area : 1;
        for (size_t node = 0; node < tree.size(); ++node) plans_[node] = plan(tree[node]);
    }

    WideTree run()
    {
        WideTree wide = emit();
        if (wide.levels > shared::BVH_STACK_SIZE) { // never seen but for scenes made for it
            byHeight_ = true;
            wide = emit();
        }
        CHECK_LE(wide.levels, shared::BVH_STACK_SIZE);
        return wide;
    }

  private:
    Plan plan(const BinaryNode& node) const
    {
        Plan plan;
        const float area = std::max(node.box.halfArea(), leastArea_);
        if (node.isLeaf()) {
            plan.cost.fill(area * BVH_PAIR_COST);
            return plan;
        }
        const Plan& left = plans_[node.left];
        const Plan& right = plans_[node.right];
        plan.pairs = left.pairs + right.pairs;
        plan.height = 1 + std::max(left.height, right.height);

        const auto split = [&](uint32_t roots) {
            std::pair<float, uint8_t> best = {std::numeric_limits<float>::infinity(), uint8_t{1}};
            for (uint32_t k = 1; k < roots; ++k)
                best = std::min(best, {left.cost[k - 1] + right.cost[roots - k - 1], uint8_t(k)});
            return best;
        };
        const auto [forest, leftOfEight] = split(BVH_WIDTH);
        plan.left[BVH_WIDTH - 2] = leftOfEight;
        const float asNode = forest + area * BVH_NODE_COST;
        const float asLeaf = area * float(plan.pairs) * BVH_PAIR_COST;
        plan.leaf = plan.pairs <= BVH_LEAF_PAIRS && asLeaf <= asNode;
        plan.cost[0] = plan.leaf ? asLeaf : asNode;
        for (uint32_t roots = 2; roots < BVH_WIDTH; ++roots) {
            const auto [cost, leftRoots] = split(roots);
            const bool better = cost < plan.cost[roots - 2];
            plan.cost[roots - 1] = better ? cost : plan.cost[roots - 2];
            plan.left[roots - 2] = better ? leftRoots : uint8_t{0};
        }
        return plan;
    }

    void gather(uint32_t node, uint32_t roots, Roots& out) const
    {
        while (roots > 1 && !tree_[node].isLeaf() && plans_[node].left[roots - 2] == 0) --roots;
        if (roots == 1 || tree_[node].isLeaf()) {
            out.push_back(node);
            return;
        }
        const uint32_t leftRoots = plans_[node].left[roots - 2];
        gather(tree_[node].left, leftRoots, out);
        gather(tree_[node].right, roots - leftRoots, out);
    }

    // The binary nodes that become the slots of the wide node made from `node`.
    Roots childrenOf(uint32_t node) const
    {
        Roots roots;
        if (isLeaf(node))
            roots = {node}; // the root of a tiny tree
        else if (byHeight_)
            roots = tallestOpened(node);
        else
            gather(node, BVH_WIDTH, roots);
        return roots;
    }

    // Each wide level takes three binary ones, whatever the tree's shape: bounds the depth.
    Roots tallestOpened(uint32_t node) const
    {
        const auto height = [&](uint32_t root) { return isLeaf(root) ? 0 : plans_[root].height; };
        Roots roots = {node};
        while (roots.size() < BVH_WIDTH) {
            const auto tallest = std::max_element(roots.begin(), roots.end(),
                                                  [&](uint32_t a, uint32_t b) { return height(a) < height(b); });
            if (height(*tallest) == 0) break;
            const BinaryNode& opened = tree_[*tallest];
            *tallest = opened.left;
            roots.push_back(opened.right);
        }
        return roots;
    }

    bool isLeaf(uint32_t node) const { return byHeight_ ? plans_[node].pairs <= BVH_LEAF_PAIRS : plans_[node].leaf; }

    void gatherPairs(uint32_t node, std::vector<uint32_t>& out) const
    {
        if (tree_[node].isLeaf()) {
            out.push_back(tree_[node].left);
        } else {
            gatherPairs(tree_[node].left, out);
            gatherPairs(tree_[node].right, out);
        }
    }

    // The root in each slot, NONE in those that are left, so that ascending (slot xor signs of the direction) is
    // roughly front to back: greedily the pair of root and slot's diagonal that agree best (Section 3.2).
    std::array<uint32_t, BVH_WIDTH> inSlots(Roots roots, glm::vec3 center) const
    {
        std::array<uint32_t, BVH_WIDTH> slots;
        slots.fill(NONE);
        while (!roots.empty()) {
            float best = -std::numeric_limits<float>::infinity();
            size_t bestRoot = 0;
            uint32_t bestSlot = 0;
            for (size_t root = 0; root < roots.size(); ++root) {
                const glm::vec3 offset = tree_[roots[root]].box.center() - center;
                for (uint32_t slot = 0; slot < BVH_WIDTH; ++slot) {
                    if (slots[slot] != NONE) continue;
                    const float agreement = ((slot & 1u) != 0 ? offset.x : -offset.x) +
                                            ((slot & 2u) != 0 ? offset.y : -offset.y) +
                                            ((slot & 4u) != 0 ? offset.z : -offset.z);
                    if (agreement > best) {
                        best = agreement;
                        bestRoot = root;
                        bestSlot = slot;
                    }
                }
            }
            slots[bestSlot] = roots[bestRoot];
            roots.erase(roots.begin() + std::ptrdiff_t(bestRoot));
        }
        return slots;
    }

    WideTree emit() const
    {
        WideTree wide;
        wide.nodes.emplace_back();
        if (!tree_.empty()) emitNode(uint32_t(tree_.size() - 1), 0, 1, wide);
        return wide;
    }

    // Depth first, so that a subtree lies together in memory.
    void emitNode(uint32_t node, uint32_t index, uint32_t level, WideTree& wide) const
    {
        wide.levels = std::max(wide.levels, level);
        const std::array<uint32_t, BVH_WIDTH> slots = inSlots(childrenOf(node), tree_[node].box.center());
        WideNode result;
        std::vector<uint32_t> inner;
        const uint32_t firstChild = uint32_t(wide.nodes.size());
        for (uint32_t slot = 0; slot < BVH_WIDTH; ++slot) {
            const uint32_t root = slots[slot];
            if (root == NONE) continue;
            WideChild& child = result.slots[slot];
            child.box = tree_[root].box;
            if (isLeaf(root)) {
                child.kind = WideChild::Kind::Leaf;
                child.first = uint32_t(wide.pairs.size());
                gatherPairs(root, wide.pairs);
                const auto begin = wide.pairs.begin() + child.first; // spatial splits can bring one twice
                std::sort(begin, wide.pairs.end());
                wide.pairs.erase(std::unique(begin, wide.pairs.end()), wide.pairs.end());
                child.count = uint8_t(wide.pairs.size() - child.first);
            } else {
                child.kind = WideChild::Kind::Node;
                child.first = firstChild + uint32_t(inner.size());
                inner.push_back(root);
            }
        }
        wide.nodes[index] = result;
        wide.nodes.resize(wide.nodes.size() + inner.size());
        for (size_t i = 0; i < inner.size(); ++i) emitNode(inner[i], firstChild + uint32_t(i), level + 1, wide);
    }

    const BinaryTree& tree_;
    float leastArea_;
    std::vector<Plan> plans_;
    bool byHeight_ = false;
};

} // namespace

WideTree collapse(const BinaryTree& tree)
{
    return Collapser(tree).run();
}

void refit(WideTree& tree, std::span<const uint32_t> nodes, std::span<const TrianglePair> pairs, const BvhInput& input)
{
    const auto boxOfNode = [&](uint32_t node) {
        Box box;
        for (const WideChild& child : tree.nodes[node].slots)
            if (child.kind != WideChild::Kind::Empty) box.extend(child.box);
        return box;
    };
    for (const uint32_t n : nodes) {
        for (WideChild& child : tree.nodes[n].slots) {
            if (child.kind == WideChild::Kind::Node) child.box = boxOfNode(child.first);
            if (child.kind != WideChild::Kind::Leaf) continue;
            child.box = {};
            for (uint32_t i = 0; i < child.count; ++i)
                child.box.extend(boxOf(input, pairs[tree.pairs[child.first + i]]));
        }
    }
}

double sahCost(const WideTree& tree)
{
    Box root;
    for (const WideChild& child : tree.nodes[0].slots) root.extend(child.box);
    if (tree.pairs.empty() || root.halfArea() == 0) return 0;
    double cost = BVH_NODE_COST * root.halfArea();
    for (const WideNode& node : tree.nodes)
        for (const WideChild& child : node.slots) {
            if (child.kind == WideChild::Kind::Node) cost += BVH_NODE_COST * child.box.halfArea();
            if (child.kind == WideChild::Kind::Leaf) cost += BVH_PAIR_COST * child.count * child.box.halfArea();
        }
    return cost / root.halfArea();
}

} // namespace scene
