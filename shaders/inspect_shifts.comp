#version 460
#extension GL_GOOGLE_include_directive : require
// How the frame's spatial shifts of each pixel's samples to its neighbors ended, found out by shifting once more, for the
// window; no stage of a frame.
#define STAGE STAGE_SPATIAL_TRACE
#include "lib/frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
TABLE(SET_PASS, 1, Reservoirs);
TABLE(SET_PASS, 2, ReservoirPaths);
TABLE(SET_PASS, 3, Shifted);
TABLE_OUT(SET_PASS, 4, ShiftCounts); // two rows a pixel, by slot: a word for each outcome

#include "shift.glsl"
#include "restir/reservoir_store.glsl"
LOAD_RESERVOIRS(Reservoirs, Reservoirs, ReservoirPaths)
LOAD_SHIFTED(Shifted)

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    uint slot = gl_GlobalInvocationID.z;
    if (at.x >= frame.width || at.y >= frame.height) return;
    uint pixel = at.y * frame.width + at.x;

    uint neighbor = neighborIn(pixel, slot);
    if (neighbor != NO_NEIGHBOR) {
        Reservoir own[MAX_RESERVOIRS];
        loadReservoirs(pixel, own);
        vec3 f[MAX_RESERVOIRS];
        shiftInto(makeDomain(neighbor, false), own, f);
    }
    uint row = 2u * (slot * pixelCount() + pixel);
    STORE(ShiftCounts, row, uvec4(shiftOutcomes[0], shiftOutcomes[1], shiftOutcomes[2], shiftOutcomes[3]));
    STORE(ShiftCounts, row + 1u, uvec4(shiftOutcomes[4], shiftOutcomes[5], 0u, 0u));
}
