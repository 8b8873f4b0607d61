#include "engine/scene/bvh_tree.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace scene
{

namespace
{

constexpr uint32_t PASSES = 2;          // a third gains a tenth of what the second does (tests/bench/LOG.md)
constexpr size_t MOVED_SHARE = 10;      // one node in so many, the largest: they are what rays meet most
constexpr size_t LONGEST_SEARCH = 2000; // nodes: seen only where everything overlaps

class Reinserter
{
  public:
    explicit Reinserter(BinaryTree tree) : tree_(std::move(tree)), parents_(tree_.size(), NONE)
    {
        for (uint32_t node = 0; node < tree_.size(); ++node)
            if (!tree_[node].isLeaf()) parents_[tree_[node].left] = parents_[tree_[node].right] = node;
    }

    void pass()
    {
        std::vector<std::pair<float, uint32_t>> largest;
        for (uint32_t node = 0; node < tree_.size(); ++node) largest.emplace_back(-tree_[node].box.halfArea(), node);
        const auto end = largest.begin() + std::ptrdiff_t(largest.size() / MOVED_SHARE);
        std::partial_sort(largest.begin(), end, largest.end());
        for (auto moved = largest.begin(); moved != end; ++moved) move(moved->second);
    }

    // Children before parents again; empty when the tree has become deeper than `depth`.
    BinaryTree ordered(uint32_t depth) const
    {
        std::vector<uint32_t> nodes = {root()}; // level by level
        size_t level = 0;
        for (size_t next = 0; next < nodes.size(); ++level) {
            if (level > depth) return {};
            for (const size_t end = nodes.size(); next < end; ++next)
                if (const BinaryNode& node = tree_[nodes[next]]; !node.isLeaf())
                    nodes.insert(nodes.end(), {node.right, node.left});
        }
        std::vector<uint32_t> places(tree_.size());
        BinaryTree result;
        result.reserve(tree_.size());
        for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
            places[*node] = uint32_t(result.size());
            BinaryNode copy = tree_[*node];
            if (!copy.isLeaf()) copy.left = places[copy.left], copy.right = places[copy.right];
            result.push_back(copy);
        }
        return result;
    }

  private:
    uint32_t root() const { return uint32_t(tree_.size() - 1); }

    static Box unionOf(Box a, const Box& b)
    {
        a.extend(b);
        return a;
    }

    uint32_t& linkTo(uint32_t child)
    {
        BinaryNode& parent = tree_[parents_[child]];
        return parent.left == child ? parent.left : parent.right;
    }

    void fitAbove(uint32_t node)
    {
        for (uint32_t i = parents_[node]; i != NONE; i = parents_[i]) {
            const Box box = unionOf(tree_[tree_[i].left].box, tree_[tree_[i].right].box);
            if (box.lower == tree_[i].box.lower && box.upper == tree_[i].box.upper) break;
            tree_[i].box = box;
        }
    }

    // Takes a node out, its parent with it, and puts both back above the node where the tree grows least.
    void move(uint32_t node)
    {
        const uint32_t parent = parents_[node];
        if (parent == NONE || parent == root()) return;
        const uint32_t sibling = tree_[parent].left == node ? tree_[parent].right : tree_[parent].left;
        linkTo(parent) = sibling;
        parents_[sibling] = parents_[parent];
        fitAbove(sibling);

        const uint32_t place = cheapestSibling(tree_[node].box, sibling);
        linkTo(place) = parent;
        parents_[parent] = parents_[place];
        tree_[parent] = {unionOf(tree_[place].box, tree_[node].box), place, node};
        parents_[place] = parents_[node] = parent;
        fitAbove(parent);
    }

    // What inner nodes' areas sum to more with `box` beside `sibling`.
    float growthBeside(uint32_t sibling, const Box& box) const
    {
        float growth = unionOf(tree_[sibling].box, box).halfArea();
        for (uint32_t i = parents_[sibling]; i != NONE; i = parents_[i])
            growth += unionOf(tree_[i].box, box).halfArea() - tree_[i].box.halfArea();
        return growth;
    }

    // Branch and bound; `first` unless another is better.
    uint32_t cheapestSibling(const Box& box, uint32_t first)
    {
        const float area = box.halfArea();
        float least = growthBeside(first, box);
        uint32_t best = first;
        candidates_.assign(1, {0.0f, root()});
        for (size_t visits = 0; !candidates_.empty() && visits < LONGEST_SEARCH; ++visits) {
            std::pop_heap(candidates_.begin(), candidates_.end(), std::greater<>());
            const auto [growthAbove, candidate] = candidates_.back();
            candidates_.pop_back();
            if (growthAbove + area >= least) break;
            const BinaryNode& node = tree_[candidate];
            const float cost = growthAbove + unionOf(node.box, box).halfArea();
            if (cost < least && candidate != root()) {
                least = cost;
                best = candidate;
            }
            const float growth = cost - node.box.halfArea();
            if (node.isLeaf() || growth + area >= least) continue;
            for (const uint32_t child : {node.left, node.right}) {
                candidates_.emplace_back(growth, child);
                std::push_heap(candidates_.begin(), candidates_.end(), std::greater<>());
            }
        }
        return best;
    }

    BinaryTree tree_;
    std::vector<uint32_t> parents_;
    std::vector<std::pair<float, uint32_t>> candidates_; // a heap: growth of the ancestors, node
};

} // namespace

BinaryTree reinsert(BinaryTree tree)
{
    if (tree.size() < 4 * MOVED_SHARE) return tree;
    Reinserter reinserter(tree);
    for (uint32_t i = 0; i < PASSES; ++i) reinserter.pass();
    BinaryTree better = reinserter.ordered(BVH_MAX_BINARY_DEPTH);
    return better.empty() ? tree : better;
}

} // namespace scene
