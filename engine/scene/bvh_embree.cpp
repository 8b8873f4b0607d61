#include "engine/scene/bvh_tree.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <new>
#include <type_traits>

#include <embree3/rtcore.h>
#include <embree3/rtcore_builder.h>
#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

#include "engine/base/check.h"
#include "engine/base/error.h"

namespace scene
{

namespace
{

// Spatial splits may add this part of the triangles: beyond it the cost hardly falls (tests/bench/LOG.md).
constexpr double SPATIAL_SPLIT_GROWTH = 0.3;
constexpr double EMBREE_SHARE = 0.8; // of the whole build's time, for progress

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
BinaryTree build(BuildContext& context, std::span<const Box> boxes, bool spatialSplits)
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

} // namespace

BinaryTree buildBinaryTree(std::span<const Box> boxes)
{
    BuildContext context;
    return build(context, boxes, false);
}

BinaryTree buildBinaryTree(const BvhInput& input, std::span<const TrianglePair> pairs, bool spatialSplits)
{
    BuildContext context{.input = &input, .pairs = pairs};
    std::vector<Box> boxes;
    boxes.reserve(pairs.size());
    for (const TrianglePair& pair : pairs) boxes.push_back(boxOf(input, pair));
    return build(context, boxes, spatialSplits);
}

} // namespace scene
