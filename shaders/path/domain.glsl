// Domains: the integral of one pixel in one frame. With shift.glsl and candidates.glsl all that resampling knows of light
// transport; tests put a closed-form integrand in place of the three. What stages use of them: Domain.seen, makeDomain, alike,
// carriedOn, reproject, enterWorld; shiftInto, renewed, countShifts; offerCandidates, offerCandidatesOf, countCandidates.
#ifndef SHADERS_PATH_DOMAIN_GLSL
#define SHADERS_PATH_DOMAIN_GLSL

#include "path/primary_hit.glsl"

// What the pixel sees, and from where.
struct Domain {
    bool seen; // else the primary ray left the scene, and there is nothing to integrate
    uint triangle;
    vec2 barycentric;
    vec3 position;
    vec3 normal; // geometric, on the camera's side
    vec3 wo;
    float footprint;
};

// What the pixel's path sees of x_1, as an area: 0.0002 of the sphere around x_1 that the camera lies on, as x_1 faces it. For
// parallel rays as seen at half a unit of height per unit of distance. (Lin et al. 2026, "ReSTIR PT Enhanced", section 4.)
float footprintOf(CameraUniform camera, vec3 position, vec3 normal, vec3 wo)
{
    const float PART = 0.0002 * 4.0 * PI;
    vec3 d = position - camera.position.xyz;
    float squared = ORTHOGRAPHIC ? 4.0 * dot(camera.up.xyz, camera.up.xyz) : dot(d, d);
    return PART * squared / abs(dot(normal, wo));
}

// Of what was hit there, in the world that has been entered.
Domain domainOf(Hit hit, CameraUniform camera)
{
    Domain d;
    d.seen = hit.triangle != NO_HIT;
    if (!d.seen) return d;
    d.triangle = hit.triangle;
    d.barycentric = hit.barycentric;
    TriangleGeometry g = loadTriangle(d.triangle);
    d.position = pointOn(g, d.barycentric);
    d.wo = towardsCamera(camera, d.position);
    d.normal = normalize(g.areaNormal);
    if (dot(d.normal, d.wo) < 0.0) d.normal = -d.normal;
    d.footprint = footprintOf(camera, d.position, d.normal, d.wo);
    return d;
}

Domain makeDomain(uint pixel, bool previous)
{
    CameraUniform camera = frame.camera;
    if (previous) camera = frame.previousCamera;
    enterWorld(previous);
    Domain d = domainOf(seenBy(pixel, previous), camera);
    enterWorld(false);
    return d;
}

// What was seen in the frame before, where it is by now.
Domain carriedOn(Domain before)
{
    if (!BETWEEN_WORLDS || !before.seen) return before;
    return domainOf(Hit(before.triangle, before.barycentric, 0.0), frame.camera);
}

// Are two domains near enough to each other that reuse pays? Asks the geometry only, never the samples: unbiased.
bool alike(Domain a, Domain b)
{
    float distance = length(a.position - frame.camera.position.xyz);
    return a.seen && b.seen && dot(a.normal, b.normal) > 0.9 &&
           abs(dot(a.normal, b.position - a.position)) < 0.02 * (ORTHOGRAPHIC ? length(frame.camera.up.xyz) : distance);
}

// The pixel of the previous frame, of the same run, that saw the same point.
bool reproject(Domain here, uint pixel, out uint previousPixel)
{
    previousPixel = pixel;
    if (SAME_VIEW) return true;
    enterWorld(true);
    vec3 p = project(frame.previousCamera, BETWEEN_WORLDS ? hitPosition(here.triangle, here.barycentric) : here.position);
    enterWorld(false);
    if (p.z <= 0.0) return false;
    vec2 size = vec2(frame.width, frame.runHeight);
    vec2 at = floor((p.xy / p.z * vec2(0.5, -0.5) + 0.5) * size);
    if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, size))) return false;
    uint runTop = pixel / frame.width / frame.runHeight * frame.runHeight;
    previousPixel = (runTop + uint(at.y)) * frame.width + uint(at.x);
    return true;
}

#endif
