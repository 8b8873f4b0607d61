// The surface that a ray meets first, also where it runs along an edge.
#ifndef SHADERS_SCENE_TRACE_GLSL
#define SHADERS_SCENE_TRACE_GLSL

#include "scene/surface.glsl" // alphaPasses, which traversal asks

#include "scene/intersect.glsl"

// On the outline of a body, as seen along the ray, a face in front and one behind meet at one distance, and rounding decides
// which is nearer. A path that took the one behind would go on inside the body. So a ray that meets an edge, as far as
// rounding can tell, is traced once more, to a point of that triangle clear of its edges: what is in front is met before.
// Unless it would be another ray altogether, so near to its origin; nor a surface that has been asked whether it exists: asked
// again elsewhere, it would exist by alpha twice.
Hit nearestHit(Ray ray, uint alphaSeed)
{
    Hit hit = Hit(NO_HIT, vec2(0.0), 0.0);
    uint round = 0u;
    bool again = true;
    LOOP_BEGIN(again)
        Hit found = closestHit(ray, alphaSeed);
        bool meets = again && found.triangle != NO_HIT;
        hit.triangle = again ? found.triangle : hit.triangle;
        hit.barycentric = again ? found.barycentric : hit.barycentric;
        hit.t = again ? found.t : hit.t;
        TriangleGeometry g = loadTriangle(meets ? found.triangle : 0u);
        vec3 clear = normalize(pointOn(g, found.barycentric) - ray.origin);
        again = meets && round == 0u && leastWeight(found.barycentric) < EDGE_WEIGHT * g.clearance &&
                dot(clear, ray.direction) > 0.9999 && !(HAS_ALPHA && isAsked(g));
        ray.direction = again ? clear : ray.direction;
        ++round;
    LOOP_END(again)
    return hit;
}

#endif
