#version 460
#extension GL_GOOGLE_include_directive : require
// Stage 3. For every pixel and slot: picks a neighbor, shifts its samples here and this pixel's samples there.
#define STAGE STAGE_SPATIAL_TRACE
#include "lib/frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_PASS, binding = 1, std430) readonly buffer Reservoirs { uvec4 reservoirs[]; };
layout(set = SET_PASS, binding = 2, std430) readonly buffer ReservoirPaths { uvec4 reservoirPaths[]; };
layout(set = SET_PASS, binding = 3, std430) writeonly buffer Neighbors { uint neighbors[]; }; // pixel, by slot
// By slot and reservoir: f here of the neighbor's sample; ratio of targets (there over here) of this pixel's sample.
layout(set = SET_PASS, binding = 4, std430) writeonly buffer Shifted { vec4 shifted[]; };

#include "integrand.glsl"
#include "restir/estimator.glsl"
#include "restir/neighbors.glsl"
#include "restir/reservoir_store.glsl"
LOAD_RESERVOIRS(Reservoirs, reservoirs, reservoirPaths)

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    uint slot = gl_GlobalInvocationID.z;
    if (at.x >= frame.width || at.y >= frame.height) return;
    uint pixel = at.y * frame.width + at.x;

    Domain here = makeDomain(pixel, false);
    uint neighbor = here.seen ? chooseNeighbor(at, slot, here) : NO_NEIGHBOR;
    neighbors[slot * pixelCount() + pixel] = neighbor;
    if (neighbor == NO_NEIGHBOR) return;

    Domain there = makeDomain(neighbor, false);
    Reservoir own[MAX_RESERVOIRS];
    loadReservoirs(pixel, own);
    vec3 fHere[MAX_RESERVOIRS];
    vec3 fThere[MAX_RESERVOIRS];
    for (uint way = 0u; way < 2u; ++way) { // a loop, so that the walk is compiled once
        bool outward = way != 0u;
        vec3 f[MAX_RESERVOIRS];
        Reservoir subjects[MAX_RESERVOIRS];
        Domain to = there;
        subjects = own;
        if (!outward) {
            to = here;
            loadReservoirs(neighbor, subjects);
        }
        shiftInto(to, subjects, f);
        if (outward) fThere = f;
        else fHere = f;
    }
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        float rho = ratio(targetOf(c, fThere[c]), targetOf(c, own[c].f));
        shifted[(slot * RESERVOIR_COUNT + c) * pixelCount() + pixel] = vec4(fHere[c], rho);
    }
    countShifts();
}
