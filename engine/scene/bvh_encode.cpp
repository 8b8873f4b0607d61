#include "engine/scene/bvh_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/base/check.h"
#include "shaders/shared/bvh.h"

namespace scene
{

namespace
{

// Boxes grow by this part of the scene's largest coordinate: more than what rounding in the traversal's slab test can
// lose. With the ray's origin within 5 R of every plane, the errors of the plane's distance (subtraction, product with
// the inverse direction of 2.5 ulp, byte times step, sum), seen as a shift of the plane, sum to under 32 * 2^-24 R. It
// also covers the triangle's own error in t, so that a triangle is never nearer than its box.
constexpr double BOX_MARGIN = 0x1p-19;

struct Grid {
    float corner = 0;
    int exponent = 1; // biased by 127
    double step() const { return std::ldexp(1.0, exponent - 127); }
};

Grid fitGrid(double lower, double upper)
{
    Grid grid;
    grid.corner = float(lower);
    if (double(grid.corner) > lower) grid.corner = std::nextafter(grid.corner, -std::numeric_limits<float>::infinity());
    int exponent = 0;
    std::frexp((upper - double(grid.corner)) / 255.0, &exponent); // 2^exponent exceeds the quotient
    grid.exponent = std::max(exponent + 127, 1);
    CHECK_LE(grid.exponent, 254);
    return grid;
}

uint32_t quantize(double value)
{
    CHECK(value >= 0.0 && value <= 255.0);
    return uint32_t(value);
}

// Those of one node are contiguous, in order of slots.
uint32_t firstRecordOf(const WideNode& node)
{
    for (const WideChild& child : node.slots)
        if (child.kind == WideChild::Kind::Leaf) return child.first;
    return 0;
}

std::array<glm::uvec4, shared::BVH_NODE_STRIDE> encode(const WideNode& node, uint32_t firstNode, float margin)
{
    Box box;
    for (const WideChild& child : node.slots)
        if (child.kind != WideChild::Kind::Empty) box.extend(child.box);

    std::array<glm::uvec4, shared::BVH_NODE_STRIDE> words = {};
    const uint32_t masks = masksOf(node);
    words[1] = {masks, firstNode << 8, firstRecordOf(node), 0};
    if (masks == 0) return words;
    for (int axis = 0; axis < 3; ++axis) {
        const Grid grid = fitGrid(double(box.lower[axis]) - margin, double(box.upper[axis]) + margin);
        words[0][axis] = std::bit_cast<uint32_t>(grid.corner);
        words[0].w |= uint32_t(grid.exponent) << (8 * axis);
        for (uint32_t slot = 0; slot < BVH_WIDTH; ++slot) {
            const WideChild& child = node.slots[slot];
            if (child.kind == WideChild::Kind::Empty) continue;
            const double lower = (double(child.box.lower[axis]) - margin - double(grid.corner)) / grid.step();
            const double upper = (double(child.box.upper[axis]) + margin - double(grid.corner)) / grid.step();
            const auto put = [&](int plane, uint32_t value) { // planes: lower x y z, upper x y z; two words each
                const int word = 2 * plane + int(slot / 4);
                words[size_t(2 + word / 4)][word % 4] |= value << (8 * (slot % 4));
            };
            put(axis, quantize(std::floor(lower)));
            put(3 + axis, quantize(std::ceil(upper)));
        }
    }
    return words;
}

} // namespace

float magnitudeOf(const WideTree& tree)
{
    float magnitude = 0;
    for (const WideChild& child : tree.nodes[0].slots) {
        if (child.kind == WideChild::Kind::Empty) continue;
        const glm::vec3 largest = glm::max(glm::abs(child.box.lower), glm::abs(child.box.upper));
        magnitude = std::max({magnitude, largest.x, largest.y, largest.z});
    }
    return magnitude;
}

void encodeNode(const WideTree& tree, const NodeLayout& layout, float magnitude, uint32_t node,
                std::span<glm::uvec4> table)
{
    const auto words = encode(tree.nodes[node], layout.first[node], static_cast<float>(BOX_MARGIN * magnitude));
    std::ranges::copy(words, table.begin() + std::ptrdiff_t(layout.row[node] * shared::BVH_NODE_STRIDE));
}

std::vector<glm::uvec4> encodeNodes(const WideTree& tree, const NodeLayout& layout, float magnitude)
{
    std::vector<glm::uvec4> table(size_t{layout.rows} * shared::BVH_NODE_STRIDE);
    for (uint32_t i = 0; i < tree.nodes.size(); ++i) encodeNode(tree, layout, magnitude, i, table);
    return table;
}

void encodeRecord(const WideTree& tree, std::span<const TrianglePair> pairs, const BvhInput& input, uint32_t record,
                  std::span<glm::uvec4> table)
{
    auto row = table.begin() + std::ptrdiff_t(size_t{record} * shared::BVH_RECORD_STRIDE);
    const auto add = [&](uint32_t triangle, uint32_t corner, uint32_t tag) {
        const glm::vec3 v = input.positions[input.triangles[triangle].vertices[corner % 3]];
        *row++ = {std::bit_cast<uint32_t>(v.x), std::bit_cast<uint32_t>(v.y), std::bit_cast<uint32_t>(v.z), tag};
    };
    const TrianglePair& pair = pairs[tree.pairs[record]];
    const bool alpha = !input.needsAlphaTest.empty() && input.needsAlphaTest[pair.first] != 0;
    add(pair.first, pair.firstTurn, pair.first | (alpha ? shared::BVH_ALPHA_FLAG : 0u));
    add(pair.first, pair.firstTurn + 1, pair.second == NONE ? 0u : pair.second);
    add(pair.first, pair.firstTurn + 2, pair.firstTurn);
    if (pair.second == NONE)
        add(pair.first, pair.firstTurn + 1, 0u);
    else
        add(pair.second, pair.secondTurn, pair.secondTurn);
}

std::vector<glm::uvec4> encodeTriangles(const WideTree& tree, std::span<const TrianglePair> pairs,
                                        const BvhInput& input)
{
    std::vector<glm::uvec4> table(std::max<size_t>(tree.pairs.size(), 1) * shared::BVH_RECORD_STRIDE); // never empty
    for (uint32_t record = 0; record < tree.pairs.size(); ++record) encodeRecord(tree, pairs, input, record, table);
    return table;
}

} // namespace scene
