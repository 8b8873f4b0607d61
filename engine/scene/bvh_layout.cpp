#include "engine/scene/bvh_tree.h"

#include <algorithm>
#include <bit>

namespace scene
{

namespace
{

// Hands out rows of a table: for a pattern of bits the first base whose rows base + bit are all free.
class RowAllocator
{
  public:
    uint32_t allocate(uint32_t pattern)
    {
        if (pattern == 0) return 0;
        const auto lowest = uint32_t(std::countr_zero(pattern));
        const uint32_t begin = rows_ > LOOK_BACK ? rows_ - LOOK_BACK : 0;
        for (uint32_t row = std::max(begin, lowest);; ++row) {
            const uint32_t base = row - lowest;
            if ((taken(base) & pattern) != 0) continue;
            take(base, pattern);
            return base;
        }
    }
    uint32_t rows() const { return rows_; }

  private:
    static constexpr uint32_t LOOK_BACK =
        64; // gaps farther back than this stay: keeps a subtree's rows near each other

    // The next 32 rows' bits from `base` on.
    uint32_t taken(uint32_t base)
    {
        words_.resize(std::max<size_t>(words_.size(), base / 32 + 2));
        const uint64_t pair = uint64_t{words_[base / 32]} | uint64_t{words_[base / 32 + 1]} << 32;
        return uint32_t(pair >> (base % 32));
    }
    void take(uint32_t base, uint32_t pattern)
    {
        const uint64_t pair = uint64_t{pattern} << (base % 32);
        words_[base / 32] |= uint32_t(pair);
        words_[base / 32 + 1] |= uint32_t(pair >> 32);
        rows_ = std::max(rows_, base + uint32_t(std::bit_width(pattern)));
    }

    std::vector<uint32_t> words_; // a bit a row
    uint32_t rows_ = 0;
};

} // namespace

uint32_t masksOf(const WideNode& node)
{
    uint32_t masks = 0;
    for (uint32_t slot = 0; slot < BVH_WIDTH; ++slot) {
        const WideChild& child = node.slots[slot];
        if (child.kind == WideChild::Kind::Node) masks |= 1u << (24 + slot);
        if (child.kind == WideChild::Kind::Leaf) masks |= ((1u << child.count) - 1u) << (3 * slot);
    }
    return masks;
}

NodeLayout layOut(const WideTree& tree)
{
    NodeLayout layout;
    layout.row.resize(tree.nodes.size());
    RowAllocator nodes;
    nodes.allocate(1u); // the root
    for (size_t i = 0; i < tree.nodes.size(); ++i) {
        const WideNode& node = tree.nodes[i];
        const uint32_t firstNode = nodes.allocate(masksOf(node) >> 24);
        layout.first.push_back(firstNode);
        for (uint32_t slot = 0; slot < BVH_WIDTH; ++slot)
            if (node.slots[slot].kind == WideChild::Kind::Node) layout.row[node.slots[slot].first] = firstNode + slot;
    }
    layout.rows = nodes.rows();
    return layout;
}

} // namespace scene
