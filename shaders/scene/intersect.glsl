// Rays against the scene: closestHit, occluded. The tables' layout and the tree's source: shared/bvh.h.
//
// The includer declares the tables Nodes and Triangles, the constants bool HAS_ALPHA, bool HAS_INSTANCES, uint STACK_SIZE (at
// least the trees' depth) and bool STACK_IN_REGISTERS, and bool alphaPasses(uint triangle, vec2 barycentric, uint alphaSeed),
// asked of flagged triangles only; TREE_ROOT, if the root is not node 0; INSTANCE_ROOT, that of the tree over instances, if
// there are any; and TREE_RADIUS where the tree is not a matter of where the triangles are alone: then a sphere about the
// origin says how large the scene is, or the root does where that is 0.
//
// Written for drivers that run 8 lanes under masks (lib/lanes.glsl): hence planes picked by the ray's signs, and a stack in
// registers. Mesa's CPU driver stores to an indexed array lane by lane, each behind a branch that is mispredicted when
// lanes differ: shifting all entries costs less, and traversal gains a quarter. SwiftShader loses a third by it.
#ifndef SHADERS_SCENE_INTERSECT_GLSL
#define SHADERS_SCENE_INTERSECT_GLSL

#include "lib/basis.glsl"
#include "lib/lanes.glsl"
#include "lib/offset.glsl"
#include "shared/bvh.h"

#ifndef TREE_ROOT
#define TREE_ROOT 0u
#endif
#ifndef INSTANCE_ROOT
#define INSTANCE_ROOT 0u
#endif
#ifndef TREE_RADIUS
#define TREE_RADIUS 0.0
#endif

const uint NO_HIT = 0xffffffffu;
const float RAY_MAX = 1e30; // farther than anything

struct Ray {
    vec3 origin;
    vec3 direction; // unit
    float tMax;
};

struct Hit {
    uint triangle;    // NO_HIT: none
    vec2 barycentric; // position = (1-u-v) v0 + u v1 + v v2
    float t;
};

// A ray made ready for the tree.
struct TraversalRay {
    vec3 origin;   // of the advanced ray
    float advance; // distance from Ray::origin to it
    vec3 direction;
    vec3 inverse; // of the direction, finite
    vec3 tangent; // tangent, bitangent, direction: the frame in which triangles are tested
    vec3 bitangent;
    float tMin; // a little before the origin: boxes count that rounding has put behind it
    uint signs; // bit a: component a of the direction is negative
};

// Distance to go before what the tree holds, at most two of its radii away, can begin: keeps coordinates relative to the
// origin, and their rounding, of its size however far the origin is. `radius`: of it, about the origin; 0: as the root says.
float distanceToTree(vec3 origin, vec3 direction, uint root, float radius)
{
    if (radius > 0.0) return max(-dot(origin, direction) - 2.0 * radius, 0.0);
    uvec4 frame = FETCH(Nodes, BVH_NODE_STRIDE * root);
    uvec3 exponents = (uvec3(frame.w) >> uvec3(0u, 8u, 16u)) & 255u;
    vec3 halfExtent = 127.5 * uintBitsToFloat(exponents << 23);
    vec3 center = uintBitsToFloat(frame.xyz) + halfExtent;
    return max(dot(center - origin, direction) - 2.0 * length(halfExtent), 0.0);
}

float finiteInverse(float x)
{
    const float SMALLEST = 1e-15; // moves a ray by less than 1e-15 of its length
    return 1.0 / (abs(x) < SMALLEST ? (x < 0.0 ? -SMALLEST : SMALLEST) : x);
}

TraversalRay prepare(Ray ray, uint root, float radius)
{
    TraversalRay r;
    r.advance = distanceToTree(ray.origin, ray.direction, root, radius);
    r.origin = ray.origin + r.advance * ray.direction;
    r.direction = ray.direction;
    r.inverse = vec3(finiteInverse(ray.direction.x), finiteInverse(ray.direction.y), finiteInverse(ray.direction.z));
    mat3 basis = basisFromNormal(ray.direction);
    r.tangent = basis[0];
    r.bitangent = basis[1];
    vec3 size = abs(r.origin);
    r.tMin = -POSITION_ERROR * max(size.x, max(size.y, size.z));
    r.signs = (r.inverse.x < 0.0 ? 1u : 0u) | (r.inverse.y < 0.0 ? 2u : 0u) | (r.inverse.z < 0.0 ? 4u : 0u);
    return r;
}

float byteAt(uint word, int index) { return float(int((word >> (8 * index)) & 255u)); }

// `bits` where the ray within [tMin, tMax] meets slot `i` of the four whose planes are packed in the words; else 0.
uint meetsSlot(int i, uvec3 near, uvec3 far, vec3 scale, vec3 shift, float tMin, float tMax, uint bits)
{
    float nearX = byteAt(near.x, i) * scale.x + shift.x;
    float nearY = byteAt(near.y, i) * scale.y + shift.y;
    float nearZ = byteAt(near.z, i) * scale.z + shift.z;
    float farX = byteAt(far.x, i) * scale.x + shift.x;
    float farY = byteAt(far.y, i) * scale.y + shift.y;
    float farZ = byteAt(far.z, i) * scale.z + shift.z;
    precise float enterXY = GREATER(nearX, nearY);
    precise float enterZ = GREATER(nearZ, tMin);
    precise float enter = GREATER(enterXY, enterZ);
    precise float leaveXY = LESSER(farX, farY);
    precise float leaveZ = LESSER(farZ, tMax);
    precise float leave = LESSER(leaveXY, leaveZ);
    return enter <= leave ? bits : 0u;
}

uint slotBits(uint slot) { return (7u << (3u * slot)) | (1u << (24u + slot)); }

// The children that the ray meets, as the node's masks with the others' bits cleared.
uint meetChildren(TraversalRay r, float tMax, uvec4 grid, uint masks, uvec4 a, uvec4 b, uvec4 c)
{
    vec3 scale = uintBitsToFloat((uvec3(grid.w) << uvec3(23u, 15u, 7u)) & 0x7f800000u) * r.inverse;
    vec3 shift = (uintBitsToFloat(grid.xyz) - r.origin) * r.inverse;
    bvec3 negative = lessThan(r.inverse, vec3(0.0));
    // Planes: lower x = a.xy, lower y = a.zw, lower z = b.xy, upper x = b.zw, upper y = c.xy, upper z = c.zw.
    uint hits = 0u;
    {
        uvec3 lower = uvec3(a.x, a.z, b.x);
        uvec3 upper = uvec3(b.z, c.x, c.z);
        uvec3 near = mix(lower, upper, negative);
        uvec3 far = mix(upper, lower, negative);
        for (int i = 0; i < 4; ++i) hits |= meetsSlot(i, near, far, scale, shift, r.tMin, tMax, slotBits(uint(i)));
    }
    {
        uvec3 lower = uvec3(a.y, a.w, b.y);
        uvec3 upper = uvec3(b.w, c.y, c.w);
        uvec3 near = mix(lower, upper, negative);
        uvec3 far = mix(upper, lower, negative);
        for (int i = 0; i < 4; ++i) hits |= meetsSlot(i, near, far, scale, shift, r.tMin, tMax, slotBits(uint(i) + 4u));
    }
    return hits & masks;
}

// Moves bit s to bit s ^ order: with a direction's signs for order, ascending bits are roughly front to back.
uint inOrder(uint slots, uint order)
{
    uint x = ((slots & 0x55u) << 1) | ((slots >> 1) & 0x55u);
    slots = (order & 1u) != 0u ? x : slots;
    uint y = ((slots & 0x33u) << 2) | ((slots >> 2) & 0x33u);
    slots = (order & 2u) != 0u ? y : slots;
    uint z = ((slots & 0x0fu) << 4) | ((slots >> 4) & 0x0fu);
    return (order & 4u) != 0u ? z : slots;
}

// A triangle in the ray's frame.
struct TriangleMeeting {
    bool met;     // by the ray's line
    vec3 weights; // of its corners: barycentrics times `total`
    float total;
    float t;
};

float cross2(vec2 a, vec2 b)
{
    precise float product = a.x * b.y - a.y * b.x;
    return product;
}

// `toCorner0`: from the ray's origin.
TriangleMeeting meetTriangle(TraversalRay r, vec3 weights, vec3 toCorner0, vec3 corner0, vec3 corner1, vec3 corner2)
{
    TriangleMeeting m;
    m.weights = weights;
    m.total = weights.x + weights.y + weights.z;
    vec3 normal = cross(corner1 - corner0, corner2 - corner0);
    float slope = dot(normal, r.direction);
    bool inside = (weights.x >= 0.0 && weights.y >= 0.0 && weights.z >= 0.0) ||
                  (weights.x <= 0.0 && weights.y <= 0.0 && weights.z <= 0.0);
    m.met = inside && m.total != 0.0 && slope != 0.0;
    m.t = dot(normal, toCorner0) / slope;
    return m;
}

// The nearer of a record's triangles that the ray meets before `nearest`, or at the same t and of lower index. What lies
// at the origin is not met: rays begin clear of all surfaces, on the side they belong to (lib/offset.glsl, surface.glsl's
// pointOn). Met at t = 0 or before, the second wall of a corner would be seen from behind, and light would leak in.
//
// Watertight in the sense of Woop, Benthin and Wald, 2013: a vertex's image in the ray's frame depends on nothing else,
// and two triangles see their common edge with exactly opposite values (so no contraction to fused operations). u and v
// are convex whatever the rounding; t comes from the plane, which is exact for walls along the axes.
bool meetsRecord(TraversalRay r, uint firstTriangle, uvec4 row0, uvec4 row1, uvec4 row2, uvec4 row3, bool any, Hit nearest,
                 out Hit met)
{
    vec3 corner0 = uintBitsToFloat(row0.xyz);
    vec3 corner1 = uintBitsToFloat(row1.xyz);
    vec3 corner2 = uintBitsToFloat(row2.xyz);
    vec3 corner3 = uintBitsToFloat(row3.xyz);
    vec3 to0 = corner0 - r.origin;
    vec3 to1 = corner1 - r.origin;
    vec3 to2 = corner2 - r.origin;
    vec3 to3 = corner3 - r.origin;
    vec2 p0 = vec2(dot(to0, r.tangent), dot(to0, r.bitangent));
    vec2 p1 = vec2(dot(to1, r.tangent), dot(to1, r.bitangent));
    vec2 p2 = vec2(dot(to2, r.tangent), dot(to2, r.bitangent));
    vec2 p3 = vec2(dot(to3, r.tangent), dot(to3, r.bitangent));
    float edge = cross2(p2, p1);
    vec3 firstWeights = vec3(edge, cross2(p0, p2), cross2(p1, p0));
    vec3 secondWeights = vec3(-edge, cross2(p3, p1), cross2(p2, p3));
    TriangleMeeting first = meetTriangle(r, firstWeights, to0, corner0, corner1, corner2);
    TriangleMeeting second = meetTriangle(r, secondWeights, to3, corner3, corner2, corner1);
    uint index0 = firstTriangle + (row0.w & ~BVH_ALPHA_FLAG);
    uint index1 = firstTriangle + row1.w;
    bool meetsFirst = first.met && first.t > 0.0 &&
                      (first.t < nearest.t || (!any && first.t == nearest.t && index0 < nearest.triangle));
    bool meetsSecond = second.met && second.t > 0.0 &&
                       (second.t < nearest.t || (!any && second.t == nearest.t && index1 < nearest.triangle));
    bool takesSecond =
        meetsSecond && (!meetsFirst || second.t < first.t || (second.t == first.t && index1 < index0));
    vec3 weights = takesSecond ? second.weights : first.weights;
    uint turn = takesSecond ? row3.w : row2.w;
    vec2 turned = turn == 0u ? weights.yz : turn == 1u ? weights.xy : weights.zx; // of the triangle's vertices 1 and 2
    met = Hit(takesSecond ? index1 : index0, turned / (takesSecond ? second.total : first.total),
              takesSecond ? second.t : first.t);
    return meetsFirst || meetsSecond;
}

// Node visits after which a search for the nearest hit sees to the triangles that other lanes have found. A search for
// any hit only waits for its own: it ends at the first.
const uint NODES_BEFORE_TRIANGLES = 4u;

// Depth-first: the nearest first for the nearest hit; for any hit the farthest, as a ray begins along its own surface,
// where it meets boxes but no triangles. A group is the rest of one node's child nodes: those to visit in bits 0..7, in
// that order; above them what the slot adds to; 0: none. Visits nodes until there are triangles, then tests them all, so that
// lanes in lockstep test theirs together. A triangle whose alpha must be asked interrupts that, and the search goes on where it
// was: whatever stands inside a loop is paid at each of its rounds, asked or not.
//
// The tree's triangles count from `firstTriangle`; `tMax` and the hit's t from the origin that the ray had before it advanced.
Hit search(TraversalRay r, float tMax, uint root, uint firstTriangle, uint alphaSeed, bool any)
{
    uint stack[STACK_SIZE]; // of groups: in registers with the top at 0, else at depth - 1
    uint depth = 0u;
    if (STACK_IN_REGISTERS)
        for (uint i = 0u; i < STACK_SIZE; ++i) stack[i] = 0u;

    Hit hit = Hit(NO_HIT, vec2(0.0), tMax - r.advance);
    uint order = any ? r.signs ^ 7u : r.signs;
    uint group = (root << 8) | (1u << order); // slot 0 of the base that is the root
    bool blocked = false;
    bool more = true;
    // Of the node whose triangles are to be tested.
    uint masks = 0u;
    uint firstRecord = 0u;
    uint records = 0u; // of its mask bits, those left
    // A hit if its alpha passes.
    bool asks = false;
    Hit asking = Hit(0u, vec2(0.0), 0.0);
    LOOP_BEGIN(more)
        LOOP_BEGIN(more && !asks)
            uint visits = 0u;
            LOOP_BEGIN(records == 0u && (group & 255u) != 0u && (any || visits < NODES_BEFORE_TRIANGLES))
                // Always, but after an alpha test: then there may be nothing to visit.
                bool walks = !HAS_ALPHA || (records == 0u && (group & 255u) != 0u);
                bool isFirst = records == 0u; // always; what leaves this loop must be made from what was (see the top)
                ++visits;
                uint slot = uint(findLSB(group)) ^ order;
                uint node = walks ? BVH_NODE_STRIDE * ((group >> 8) + slot) : 0u;
                uint rest = group & (group - 1u);
                bool remains = (rest & 255u) != 0u;
                if (!STACK_IN_REGISTERS) {
                    stack[depth] = rest;
                    depth += walks && remains ? 1u : 0u;
                }

                uvec4 links = FETCH(Nodes, node + 1u);
                uint hits = meetChildren(r, hit.t, FETCH(Nodes, node), links.x, FETCH(Nodes, node + 2u),
                                         FETCH(Nodes, node + 3u), FETCH(Nodes, node + 4u));
                masks = isFirst ? links.x : masks;
                firstRecord = isFirst ? links.z : firstRecord;
                records |= walks ? hits & 0xffffffu : 0u;
                uint children = links.y | inOrder(hits >> 24, order);

                bool enters = (children & 255u) != 0u;
                uint next;
                if (STACK_IN_REGISTERS) {
                    next = enters ? children : remains ? rest : stack[0];
                    bool pushes = walks && enters && remains;
                    bool pops = walks && !enters && !remains;
                    uint above = rest; // the entry before i, before it moved
                    for (uint i = 0u; i < STACK_SIZE; ++i) {
                        uint entry = stack[i];
                        uint below = i + 1u < STACK_SIZE ? stack[i + 1u] : 0u;
                        stack[i] = pushes ? above : pops ? below : entry;
                        above = entry;
                    }
                } else {
                    bool pops = walks && !enters && depth != 0u;
                    depth -= pops ? 1u : 0u;
                    uint top = stack[depth];
                    next = pops ? top : children;
                }
                group = walks ? next : group;
            LOOP_END(records == 0u && (group & 255u) != 0u && (any || visits < NODES_BEFORE_TRIANGLES))

            LOOP_BEGIN(records != 0u && !asks)
                bool valid = records != 0u && !asks; // a lane that has left to ask must keep what it asks (lib/lanes.glsl)
                uint earlier = masks & ((records & (0u - records)) - 1u); // mask bits below the lowest
                uint record = valid ? BVH_RECORD_STRIDE * (firstRecord + uint(bitCount(earlier))) : 0u;
                records &= records - 1u;
                uvec4 row0 = FETCH(Triangles, record);
                Hit found;
                bool met = meetsRecord(r, firstTriangle, row0, FETCH(Triangles, record + 1u), FETCH(Triangles, record + 2u),
                                       FETCH(Triangles, record + 3u), any, hit, found) && valid;
                if (HAS_ALPHA) {
                    bool isFlagged = met && (row0.w & BVH_ALPHA_FLAG) != 0u;
                    if (isFlagged) asking = found;
                    asks = asks || isFlagged;
                    met = met && !isFlagged;
                }
                if (any) {
                    blocked = blocked || met;
                    records = met ? 0u : records;
                } else if (met) {
                    hit = found;
                }
            LOOP_END(records != 0u && !asks)

            more = (records != 0u || (group & 255u) != 0u) && !blocked;
        LOOP_END(more && !asks)
        if (HAS_ALPHA) {
            // No `if` around the fetches: lavapipe (Mesa 22.3) miscompiled one here, and rays missed triangles
            // (tests/images/variants_test.cpp).
            bool passes = alphaPasses(asking.triangle, asking.barycentric, alphaSeed) && asks;
            asks = false;
            if (any) {
                blocked = blocked || passes;
                more = more && !blocked;
            } else if (passes) {
                hit = asking;
            }
        }
    LOOP_END(HAS_ALPHA && more)
    if (blocked) hit.triangle = 0u;
    hit.t = max(hit.t + r.advance, 0.0);
    return hit;
}

// ------------------------------------------------------------------------------------------------------------- two levels
// A walk through the tree over instances, which stops at each that the ray may meet. Its rest waits here, not in registers:
// it is asked once an instance.
uint instanceStack[BVH_STACK_SIZE];

struct InstanceWalk {
    uint group; // as search() has it
    uint depth;
    uint masks;
    uint firstRecord;
    uint records;
};

// To the next instance whose box the ray meets before tMax. False: there is none.
bool advance(inout InstanceWalk walk, TraversalRay r, float tMax, uint order)
{
    LOOP_BEGIN(walk.records == 0u && (walk.group & 255u) != 0u)
        bool walks = walk.records == 0u && (walk.group & 255u) != 0u;
        uint slot = uint(findLSB(walk.group)) ^ order;
        uint node = walks ? BVH_NODE_STRIDE * ((walk.group >> 8) + slot) : 0u;
        uint rest = walk.group & (walk.group - 1u);
        uvec4 links = FETCH(Nodes, node + 1u);
        uint hits = meetChildren(r, tMax - r.advance, FETCH(Nodes, node), links.x, FETCH(Nodes, node + 2u),
                                 FETCH(Nodes, node + 3u), FETCH(Nodes, node + 4u));
        walk.masks = walks ? links.x : walk.masks;
        walk.firstRecord = walks ? links.z : walk.firstRecord;
        walk.records = walks ? hits & 0xffffffu : walk.records;
        uint children = links.y | inOrder(hits >> 24, order);
        bool enters = (children & 255u) != 0u;
        bool remains = (rest & 255u) != 0u;
        instanceStack[walk.depth] = rest;
        walk.depth += walks && enters && remains ? 1u : 0u;
        bool pops = walks && !enters && !remains && walk.depth != 0u;
        walk.depth -= pops ? 1u : 0u;
        uint top = instanceStack[walk.depth];
        uint next = enters ? children : remains ? rest : pops ? top : 0u;
        walk.group = walks ? next : walk.group;
    LOOP_END(walk.records == 0u && (walk.group & 255u) != 0u)
    return walk.records != 0u;
}

const float BEYOND = 1.00000048; // 1 + 2^-21: what is as far, but for rounding, is found, and the distance in the world decides

// First what lies in the world, then instance by instance, roughly front to back. The ray goes into a mesh's space from where
// it has advanced in the world, so that the rounding of coordinates there is of the world's size, too.
Hit traverse(Ray ray, uint alphaSeed, bool any)
{
    Hit nearest = Hit(NO_HIT, vec2(0.0), ray.tMax);
    TraversalRay r = prepare(ray, TREE_ROOT, TREE_RADIUS);
    float tMax = ray.tMax;
    uint root = TREE_ROOT;
    uint firstTriangle = 0u;
    float scale = 1.0;  // of lengths along r, over those along `ray`
    float before = 0.0; // of `ray`, where r begins

    TraversalRay outside = r;
    InstanceWalk walk = InstanceWalk(0u, 0u, 0u, 0u, 0u);
    uint order = 0u;
    if (HAS_INSTANCES) {
        outside = prepare(ray, INSTANCE_ROOT, TREE_RADIUS);
        order = any ? outside.signs ^ 7u : outside.signs;
        walk.group = (INSTANCE_ROOT << 8) | (1u << order);
    }
    bool more = true;
    LOOP_BEGIN(more)
        Hit found = search(r, tMax, root, firstTriangle, alphaSeed, any);
        if (!HAS_INSTANCES) {
            nearest = found;
            more = false;
        } else {
            float t = before + found.t / scale;
            bool nearer = more && found.triangle != NO_HIT &&
                          (any || t < nearest.t || (t == nearest.t && found.triangle < nearest.triangle));
            nearest.triangle = nearer ? found.triangle : nearest.triangle;
            nearest.barycentric = nearer ? found.barycentric : nearest.barycentric;
            nearest.t = nearer ? t : nearest.t;
            more = more && !(any && nearer);
            if (!more) walk.group = walk.records = 0u;
            more = advance(walk, outside, nearest.t, order) && more;
            uint earlier = walk.masks & ((walk.records & (0u - walk.records)) - 1u);
            uint record = more ? BVH_RECORD_STRIDE * (walk.firstRecord + uint(bitCount(earlier))) : 0u;
            walk.records &= walk.records - 1u;
            vec4 x = uintBitsToFloat(FETCH(Triangles, record));
            vec4 y = uintBitsToFloat(FETCH(Triangles, record + 1u));
            vec4 z = uintBitsToFloat(FETCH(Triangles, record + 2u));
            uvec4 mesh = FETCH(Triangles, record + 3u);
            vec3 from = outside.origin - vec3(x.w, y.w, z.w);
            vec3 origin = vec3(dot(x.xyz, from), dot(y.xyz, from), dot(z.xyz, from));
            vec3 direction = vec3(dot(x.xyz, outside.direction), dot(y.xyz, outside.direction), dot(z.xyz, outside.direction));
            float inside = length(direction);
            scale = more ? inside : scale;
            before = more ? outside.advance : before;
            tMax = more ? (nearest.t - outside.advance) * (any ? inside : inside * BEYOND) : tMax;
            root = more ? mesh.x : root;
            firstTriangle = more ? mesh.y : firstTriangle;
            if (more) r = prepare(Ray(origin, direction / inside, 0.0), root, 0.0);
        }
    LOOP_END(HAS_INSTANCES && more)
    return nearest;
}

// The nearest triangle before tMax; of several at the same t the one of the lowest index.
Hit closestHit(Ray ray, uint alphaSeed) { return traverse(ray, alphaSeed, false); }

// Is there any triangle before tMax?
bool occluded(Ray ray, uint alphaSeed) { return traverse(ray, alphaSeed, true).triangle != NO_HIT; }

#endif
