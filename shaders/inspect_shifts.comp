#version 460
#extension GL_GOOGLE_include_directive : require
// How the frame's spatial shifts of each pixel's samples to its neighbors ended, found out by shifting once more, for the
// window; no stage of a frame.
#define STAGE STAGE_SPATIAL_TRACE
#include "lib/frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_PASS, binding = 1, std430) readonly buffer Reservoirs { uvec4 reservoirs[]; };
layout(set = SET_PASS, binding = 2, std430) readonly buffer ReservoirPaths { uvec4 reservoirPaths[]; };
layout(set = SET_PASS, binding = 3, std430) readonly buffer Neighbors { uint neighbors[]; };
layout(set = SET_PASS, binding = 4, std430) writeonly buffer ShiftCounts { uint shiftCounts[]; }; // pixel, by slot and outcome

#include "integrand.glsl"
#include "restir/reservoir_store.glsl"
LOAD_RESERVOIRS(Reservoirs, ELEMENT, reservoirs, reservoirPaths)

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    uint slot = gl_GlobalInvocationID.z;
    if (at.x >= frame.width || at.y >= frame.height) return;
    uint pixel = at.y * frame.width + at.x;

    uint neighbor = neighbors[slotRow(pixel, slot)];
    if (neighbor != NO_NEIGHBOR) {
        Reservoir own[MAX_RESERVOIRS];
        loadReservoirs(pixel, own);
        vec3 f[MAX_RESERVOIRS];
        shiftInto(makeDomain(neighbor, false), own, f);
    }
    for (uint i = 0u; i < SHIFT_OUTCOMES; ++i)
        shiftCounts[(slot * SHIFT_OUTCOMES + i) * pixelCount() + pixel] = shiftOutcomes[i];
}
