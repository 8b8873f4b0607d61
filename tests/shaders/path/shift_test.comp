#version 460
#extension GL_GOOGLE_include_directive : require
// Shifts paths into the domains of other pixels, and says what the next directions are drawn from there.
#define STAGE STAGE_TEMPORAL
#include "lib/frame.glsl"
#include "shifts.h"
layout(local_size_x = 64) in;
layout(set = SET_PASS, binding = 1, std430) readonly buffer Paths { OfferedPath paths[]; };
layout(set = SET_PASS, binding = 2, std430) readonly buffer Destinations { uint destinations[]; }; // pixels
layout(set = SET_PASS, binding = 3, std430) writeonly buffer ShiftedPaths { ShiftedPath shiftedPaths[]; };

#define DEFERS_SHADOW_RAYS
#include "path/walk.glsl"
#define visit shiftVisits // between the walk and the shift stand the functions below
#define goesOn shiftGoesOn
#include "shift.glsl"
#undef visit
#undef goesOn

uint reconnectionIndex; // of the path under way
Scattering before;

Scattering scatteringAt(Surface s, Bsdf b)
{
    return Scattering(vec4(s.position, 1.0), vec4(b.frame[0], b.alphaG), vec4(b.frame[1], b.eta),
                      vec4(b.frame[2], float(b.solid)), vec4(b.wo, 0.0), vec4(b.pick, 0.0));
}

// The walk goes on to x_(r-1) also where the shift has found that it is not defined.
bool visit(Vertex x)
{
    if (x.k + 1u == reconnectionIndex) before = scatteringAt(x.s, x.bsdf);
    return shiftVisits(x) || x.k + 1u < reconnectionIndex;
}
bool goesOn(uint k) { return shiftGoesOn(k) || k + 1u < reconnectionIndex; }

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(paths.length())) return;
    OfferedPath path = paths[i];
    const Scattering nowhere = Scattering(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    reconnectionIndex = path.reconnectionIndex;
    before = nowhere;

    Reservoir r[MAX_RESERVOIRS];
    for (uint c = 0u; c < MAX_RESERVOIRS; ++c) r[c] = EMPTY;
    r[0].chosen = PathSample(PathSeed(path.seedFrame, path.seedPixel), path.pathId, path.reconnectionIndex,
                             Reconnection(path.triangle, path.barycentric, path.direction.w, path.direction.xyz, path.suffix.xyz),
                             path.density);
    r[0].weightSum = 1.0;
    vec3 f[MAX_RESERVOIRS];
    shiftInto(makeDomain(destinations[i], false), r, f);
    countShifts();

    ShiftedPath result;
    result.f = vec4(f[0], -1.0);
    for (uint o = 0u; o < SHIFT_OUTCOMES; ++o) // one, and once: else -1 stays, or the sum is none
        if (shiftOutcomes[o] != 0u) result.f.w = result.f.w < 0.0 && shiftOutcomes[o] == 1u ? float(o) : 100.0;
    result.density = vec4(renewed(0u).density);
    result.before = before;
    result.at = nowhere;
    for (uint k = 0u; k < 3u; ++k) result.corners[k] = vec4(0.0);
    if (reconnectionIndex != 0u && path.triangle != NO_HIT && before.position.w != 0.0) {
        TriangleGeometry g = loadTriangle(path.triangle);
        result.corners[0].xyz = g.p0;
        result.corners[1].xyz = g.p1;
        result.corners[2].xyz = g.p2;
        vec3 wo = normalize(before.position.xyz - hitPosition(path.triangle, path.barycentric));
        Surface s = loadSurface(path.triangle, path.barycentric, wo);
        result.at = scatteringAt(s, makeBsdf(s, wo));
    }
    shiftedPaths[i] = result;
}
