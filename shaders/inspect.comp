#version 460
#extension GL_GOOGLE_include_directive : require
// What the frame's reservoirs hold, decoded for the window; no stage of a frame.
#include "lib/frame.glsl"
#include "shared/inspection.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_PASS, binding = 0, std430) readonly buffer Reservoirs { uvec4 reservoirs[]; };
layout(set = SET_PASS, binding = 1, std430) readonly buffer ReservoirPaths { uvec4 reservoirPaths[]; };
layout(set = SET_PASS, binding = 2, std430) readonly buffer Neighbors { uint neighbors[]; };
layout(set = SET_PASS, binding = 3, std430) readonly buffer Shifted { vec4 shifted[]; };
layout(set = SET_PASS, binding = 4, std430) readonly buffer History { uvec4 history[]; };
layout(set = SET_PASS, binding = 5, std430) readonly buffer HistoryPaths { uvec4 historyPaths[]; };
layout(set = SET_PASS, binding = 6, std430) writeonly buffer Inspections { Inspection inspections[]; };

#include "path/leaf.glsl"
#include "restir/estimator.glsl"
#include "restir/reservoir_store.glsl"
LOAD_RESERVOIRS(Reservoirs, ELEMENT, reservoirs, reservoirPaths)
LOAD_RESERVOIRS(History, ELEMENT, history, historyPaths)

// Of reservoir c: spatial shifts that had a sample to shift, and those of them that carried nothing.
uvec2 countSpatialShifts(uint pixel, uint c)
{
    uvec2 triedFailed = uvec2(0u);
    for (uint slot = 0u; slot < frame.neighborCount; ++slot) {
        uint neighbor = neighbors[slotRow(pixel, slot)];
        if (neighbor == NO_NEIGHBOR) continue;
        bool here = targetOf(c, loadReservoirsHead(neighbor, c).f) > 0.0;
        bool there = targetOf(c, loadReservoirsHead(pixel, c).f) > 0.0;
        triedFailed += uvec2(here, here && targetOf(c, shifted[shiftedRow(neighbor, slot, c)].xyz) == 0.0) +
                       uvec2(there, there && targetOf(c, shifted[shiftedRow(pixel, slot, c)].xyz) == 0.0);
    }
    return triedFailed;
}

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= frame.width || at.y >= frame.height) return;
    uint pixel = at.y * frame.width + at.x;

    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        Reservoir r = loadHistoryHead(pixel, c);
        uvec2 shifts = countSpatialShifts(pixel, c);
        Inspection seen;
        seen.seedFrame = r.chosen.seed.frame;
        seen.seedPixel = r.chosen.seed.pixel;
        seen.leafAndJoint = r.chosen.leaf | r.chosen.joint << 16u;
        seen.lengthAndShifts = scatteringsOf(r.chosen.leaf) | shifts.x << 16u | shifts.y << 24u;
        seen.weightSum = r.weightSum + r.carry;
        seen.target = targetOf(c, r.f);
        seen.weight = seen.target > 0.0 ? seen.weightSum / seen.target : 0.0;
        seen.confidence = loadHistoryConfidence(pixel);
        inspections[c * pixelCount() + pixel] = seen;
    }
}
