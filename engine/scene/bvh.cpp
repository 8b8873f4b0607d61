#include "engine/scene/bvh.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <new>
#include <numeric>
#include <type_traits>
#include <utility>

#include <embree3/rtcore.h>
#include <embree3/rtcore_builder.h>
#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

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
// Spatial splits may add this part of the triangles: beyond it the cost hardly falls (tests/bench/LOG.md).
constexpr double SPATIAL_SPLIT_GROWTH = 0.3;
constexpr double EMBREE_SHARE = 0.8; // of the whole build's time, for progress

using Corners = std::array<glm::vec3, 3>;

Corners cornersOf(const BvhInput& input, uint32_t triangle)
{
    const auto& vertices = input.triangles[triangle].vertices;
    return {input.positions[vertices[0]], input.positions[vertices[1]], input.positions[vertices[2]]};
}

bool isUsable(const Corners& v)
{
    for (const glm::vec3& corner : v)
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(corner[axis]) <= LARGEST_COORDINATE)) return false;
    const glm::dvec3 normal = glm::cross(glm::dvec3(v[1]) - glm::dvec3(v[0]), glm::dvec3(v[2]) - glm::dvec3(v[0]));
    return glm::dot(normal, normal) > 0.0;
}

// Embree's nodes while it builds; a leaf has no children.
struct BuildNode {
    std::array<BuildNode*, 2> children = {nullptr, nullptr};
    std::array<Box, 2> childBoxes;
    uint32_t pair = NONE;
};
static_assert(std::is_trivially_destructible_v<BuildNode>); // Embree's arena frees them unseen

BuildNode* newNode(RTCThreadLocalAllocator allocator)
{
    return new (rtcThreadLocalAlloc(allocator, sizeof(BuildNode), 16)) BuildNode;
}

struct BuildContext {
    const BvhInput* input = nullptr; // null: of boxes that are not split
    std::span<const TrianglePair> pairs;
    std::mutex mutex; // of progress: Embree's threads report
    double reported = 0;
    char started = 0, ended = 0; // places that Callback and its build name to the thread sanitizer
};

// libtbb, built without the thread sanitizer, starts and joins Embree's threads; so every callback says that it comes
// after the start of its build and before the end. Callbacks stay unordered among each other.
class Callback
{
  public:
    explicit Callback(void* context) : build_(*static_cast<BuildContext*>(context))
    {
#ifdef __SANITIZE_THREAD__
        __tsan_acquire(&build_.started);
#endif
    }
    ~Callback()
    {
#ifdef __SANITIZE_THREAD__
        __tsan_release(&build_.ended);
#endif
    }
    Callback(const Callback&) = delete;
    Callback& operator=(const Callback&) = delete;
    BuildContext& build() const
    {
        return build_;
    }

  private:
    BuildContext& build_;
};

const void* run(RTCBuildArguments& arguments, [[maybe_unused]] BuildContext& context)
{
#ifdef __SANITIZE_THREAD__
    __tsan_release(&context.started);
    const void* root = rtcBuildBVH(&arguments);
    __tsan_acquire(&context.ended);
    return root;
#else
    return rtcBuildBVH(&arguments);
#endif
}

RTCBounds boundsOf(const Box& box)
{
    return {box.lower.x, box.lower.y, box.lower.z, 0, box.upper.x, box.upper.y, box.upper.z, 0};
}

// The boxes of the pair's parts on either side of a plane, within the box it has already been cut to.
void splitPrimitive(const RTCBuildPrimitive* primitive, unsigned axisIndex, float position, RTCBounds* left,
                    RTCBounds* right, void* context)
{
    const Callback callback(context);
    const int axis = int(axisIndex);
    const BuildContext& build = callback.build();
    const TrianglePair& pair = build.pairs[primitive->primID];
    std::array<Box, 2> parts;
    const auto extend = [&](int side, const glm::vec3& point) { parts[size_t(side)].extend({point, point}); };
    for (const uint32_t triangle : {pair.first, pair.second}) {
        if (triangle == NONE) continue;
        const Corners v = cornersOf(*build.input, triangle);
        for (size_t i = 0; i < 3; ++i) {
            const glm::vec3 a = v[i];
            const glm::vec3 b = v[(i + 1) % 3];
            if (a[axis] <= position) extend(0, a);
            if (a[axis] >= position) extend(1, a);
            if ((a[axis] < position && b[axis] > position) || (a[axis] > position && b[axis] < position)) {
                glm::vec3 cut = glm::mix(a, b, (position - a[axis]) / (b[axis] - a[axis]));
                cut[axis] = position;
                extend(0, cut);
                extend(1, cut);
            }
        }
    }
    const Box whole = {{primitive->lower_x, primitive->lower_y, primitive->lower_z},
                       {primitive->upper_x, primitive->upper_y, primitive->upper_z}};
    for (Box& part : parts) { // a part lost to rounding becomes a point of the whole
        part.lower = glm::clamp(part.lower, whole.lower, whole.upper);
        part.upper = glm::clamp(part.upper, part.lower, whole.upper);
    }
    *left = boundsOf(parts[0]);
    *right = boundsOf(parts[1]);
}

bool reportProgress(void* context, double fraction)
{
    const Callback callback(context);
    BuildContext& build = callback.build();
    const std::lock_guard lock(build.mutex);
    if (fraction > build.reported) {
        build.reported = fraction;
        build.input->progress(EMBREE_SHARE * std::min(fraction, 1.0));
    }
    return true;
}

std::vector<uint32_t> usableTriangles(const BvhInput& input)
{
    std::vector<uint32_t> usable;
    usable.reserve(input.triangles.size());
    for (uint32_t i = 0; i < input.triangles.size(); ++i)
        if (isUsable(cornersOf(input, i))) usable.push_back(i);
    return usable;
}

std::vector<RTCBuildPrimitive> primitivesOf(std::span<const Box> boxes)
{
    std::vector<RTCBuildPrimitive> primitives;
    primitives.reserve(boxes.size());
    for (const auto& [lower, upper] : boxes)
        primitives.push_back({lower.x, lower.y, lower.z, 0, upper.x, upper.y, upper.z, uint32_t(primitives.size())});
    return primitives;
}

// Appends the subtree, children before parents; returns its root's index.
uint32_t flatten(const BuildNode& node, const Box& box, BinaryTree& out)
{
    if (node.pair != NONE) {
        out.push_back({.box = box, .left = node.pair});
    } else {
        const uint32_t left = flatten(*node.children[0], node.childBoxes[0], out);
        const uint32_t right = flatten(*node.children[1], node.childBoxes[1], out);
        out.push_back({.box = box, .left = left, .right = right});
    }
    return uint32_t(out.size() - 1);
}

// Over boxes, which the context's pairs of triangles have where they may be split.
BinaryTree buildBinaryTree(BuildContext& context, std::span<const Box> boxes, bool spatialSplits)
{
    if (boxes.empty()) return {};
    std::vector<RTCBuildPrimitive> primitives = primitivesOf(boxes);
    Box scene;
    for (const Box& box : boxes) scene.extend(box);

    const std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device(rtcNewDevice(nullptr), rtcReleaseDevice);
    if (!device) throw Error("Embree cannot start (error {}).", int(rtcGetDeviceError(nullptr)));
    const std::unique_ptr<RTCBVHTy, decltype(&rtcReleaseBVH)> bvh(rtcNewBVH(device.get()), rtcReleaseBVH);

    const size_t count = primitives.size();
    primitives.resize(count + (spatialSplits ? size_t(double(count) * SPATIAL_SPLIT_GROWTH) : 0));
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.bvh = bvh.get();
    arguments.buildQuality = RTC_BUILD_QUALITY_HIGH;
    arguments.maxBranchingFactor = 2;
    arguments.maxDepth = BVH_MAX_BINARY_DEPTH;
    arguments.minLeafSize = 1;
    arguments.maxLeafSize = 1;
    arguments.primitives = primitives.data();
    arguments.primitiveCount = count;
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = [](RTCThreadLocalAllocator allocator, unsigned, void* build) -> void* {
        const Callback callback(build);
        return newNode(allocator);
    };
    arguments.setNodeChildren = [](void* node, void** children, unsigned childCount, void* build) {
        const Callback callback(build);
        CHECK_EQ(childCount, 2u);
        for (size_t i = 0; i < 2; ++i)
            static_cast<BuildNode*>(node)->children[i] = static_cast<BuildNode*>(children[i]);
    };
    arguments.setNodeBounds = [](void* node, const RTCBounds** bounds, unsigned, void* build) {
        const Callback callback(build);
        for (size_t i = 0; i < 2; ++i)
            static_cast<BuildNode*>(node)->childBoxes[i] = {
                {bounds[i]->lower_x, bounds[i]->lower_y, bounds[i]->lower_z},
                {bounds[i]->upper_x, bounds[i]->upper_y, bounds[i]->upper_z}};
    };
    arguments.createLeaf = [](RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* leaf, size_t leafCount,
                              void* build) -> void* {
        const Callback callback(build);
        CHECK_EQ(leafCount, size_t{1});
        BuildNode* node = newNode(allocator);
        node->pair = leaf->primID;
        return node;
    };
    if (spatialSplits) arguments.splitPrimitive = splitPrimitive;
    if (context.input && context.input->progress) arguments.buildProgress = reportProgress;
    arguments.userPtr = &context;
    const void* root = run(arguments, context);
    if (root == nullptr)
        throw Error("Embree cannot build a tree over {} boxes (error {}).", count,
                    int(rtcGetDeviceError(device.get())));
    BinaryTree tree;
    tree.reserve(2 * primitives.size());
    flatten(*static_cast<const BuildNode*>(root), scene, tree);
    return tree;
}

BinaryTree buildBinaryTree(const BvhInput& input, std::span<const TrianglePair> pairs, bool spatialSplits)
{
    BuildContext context{.input = &input, .pairs = pairs};
    std::vector<Box> boxes;
    boxes.reserve(pairs.size());
    for (const TrianglePair& pair : pairs) boxes.push_back(boxOf(input, pair));
    return buildBinaryTree(context, boxes, spatialSplits);
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
    BuildContext context;
    WideTree tree = collapse(buildBinaryTree(context, boxes, false));
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
