#version 460
#extension GL_GOOGLE_include_directive : require
// Stage 3. For every pixel and slot: picks a neighbor and shifts this pixel's samples there. The neighbor has picked this
// pixel and does the same. The slots of a pixel lie side by side, so that lanes in lockstep shift the same samples.
#define STAGE STAGE_SPATIAL_TRACE
#include "lib/frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
TABLE(SET_PASS, 1, Reservoirs);
TABLE(SET_PASS, 2, ReservoirPaths);
TABLE_OUT(SET_PASS, 3, Shifted);

#include "shift.glsl"
#include "restir/neighbors.glsl"
#include "restir/reservoir_store.glsl"
LOAD_RESERVOIRS(Reservoirs, Reservoirs, ReservoirPaths)
STORE_SHIFTED(Shifted)

void main()
{
    uvec2 at = uvec2(gl_GlobalInvocationID.x / frame.neighborCount, gl_GlobalInvocationID.y);
    uint slot = gl_GlobalInvocationID.x % frame.neighborCount;
    if (at.x >= frame.width || at.y >= frame.height) return;
    uint pixel = at.y * frame.width + at.x;

    Domain here = makeDomain(pixel, false);
    uint neighbor = here.seen ? chooseNeighbor(at, slot, here) : NO_NEIGHBOR;
    vec3 f[MAX_RESERVOIRS];
    vec4 densities = vec4(1.0);
    if (neighbor != NO_NEIGHBOR) {
        Reservoir own[MAX_RESERVOIRS];
        loadReservoirs(pixel, own);
        shiftInto(makeDomain(neighbor, false), own, f);
        for (uint c = 0u; c < RESERVOIR_COUNT; ++c) densities[c] = renewed(c).density;
    }
    storeShifted(pixel, slot, neighbor, f, densities);
    countShifts();
}
