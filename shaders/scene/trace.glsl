// The surface that a ray meets first, also where it runs along an edge.
#ifndef SHADERS_SCENE_TRACE_GLSL
#define SHADERS_SCENE_TRACE_GLSL

#include "scene/surface.glsl" // alphaPasses, which traversal asks

#include "scene/intersect.glsl"

// On the outline of a body, as seen along the ray, a face in front and one behind meet at one distance, and rounding decides
// which is nearer. A path that took the one behind would go on inside the body. So a ray that meets an edge, as far as
// rounding can tell, is traced once more, to a point of that triangle clear of its edges: what is in front is met before.
// Only the end of the way is traced again, lest translucent surfaces be asked twice whether they exist; nor is the surface
// itself, if it has been asked. Nor would it do where the point is so near that its direction is another one.
Hit nearestHit(Ray ray, uint alphaSeed)
{
    const float WAY_BACK = 1.0 / 8192.0; // of the triangle's coordinates: many times what outlines are apart there
    Hit hit = Hit(NO_HIT, vec2(0.0), 0.0);
    float before = 0.0; // the way that is not traced again
    uint round = 0u;
    bool again = true;
    LOOP_BEGIN(again)
        Hit found = closestHit(ray, alphaSeed);
        bool meets = found.triangle != NO_HIT;
        bool takes = again && (round == 0u || meets);
        hit.triangle = takes ? found.triangle : hit.triangle;
        hit.barycentric = takes ? found.barycentric : hit.barycentric;
        hit.t = takes ? before + found.t : hit.t;
        TriangleGeometry g = loadTriangle(meets ? found.triangle : 0u);
        vec3 d = pointOn(g, found.barycentric) - ray.origin;
        float distance = length(d);
        vec3 clear = d / distance;
        again = again && meets && round == 0u && leastWeight(found.barycentric) < EDGE_WEIGHT * g.clearance &&
                dot(clear, ray.direction) > 0.9999 && !(HAS_ALPHA && isAsked(g));
        before = again ? max(distance - WAY_BACK * largestCoordinate(g), 0.5 * distance) : before;
        ray.origin = again ? ray.origin + before * clear : ray.origin;
        ray.direction = again ? clear : ray.direction;
        ++round;
    LOOP_END(again)
    return hit;
}

#endif
