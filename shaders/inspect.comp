#version 460
#extension GL_GOOGLE_include_directive : require
// What the frame's reservoirs hold, decoded for the window; no stage of a frame.
#include "lib/frame.glsl"
#include "shared/inspection.h"
layout(local_size_x = 8, local_size_y = 8) in;
TABLE(SET_PASS, 0, Reservoirs);
TABLE(SET_PASS, 1, ReservoirPaths);
TABLE(SET_PASS, 2, Shifted);
TABLE(SET_PASS, 3, History);
TABLE(SET_PASS, 4, HistoryPaths);
TABLE(SET_PASS, 5, HistoryConfidences);
TABLE_OUT(SET_PASS, 6, Inspections);

#include "restir/path_id.glsl"
#include "restir/estimator.glsl"
#include "restir/reservoir_store.glsl"
LOAD_RESERVOIRS(Reservoirs, Reservoirs, ReservoirPaths)
LOAD_RESERVOIRS(History, History, HistoryPaths)
LOAD_SHIFTED(Shifted)

// Of reservoir c: spatial shifts that had a sample to shift, and those of them that carried nothing.
uvec2 countSpatialShifts(uint pixel, uint c)
{
    uvec2 triedFailed = uvec2(0u);
    for (uint slot = 0u; slot < frame.neighborCount; ++slot) {
        uint neighbor = neighborIn(pixel, slot);
        if (neighbor == NO_NEIGHBOR) continue;
        bool here = targetOf(c, loadReservoirsHead(neighbor, c).f) > 0.0;
        bool there = targetOf(c, loadReservoirsHead(pixel, c).f) > 0.0;
        triedFailed += uvec2(here, here && targetOf(c, shiftedFrom(neighbor, slot, c)) == 0.0) +
                       uvec2(there, there && targetOf(c, shiftedFrom(pixel, slot, c)) == 0.0);
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
        float weightSum = r.weightSum + r.carry;
        float target = targetOf(c, r.f);
        float weight = target > 0.0 ? weightSum / target : 0.0;
        uint row = 2u * (c * pixelCount() + pixel); // of struct Inspection
        STORE(Inspections, row,
              uvec4(r.chosen.seed.frame, r.chosen.seed.pixel, r.chosen.pathId | r.chosen.reconnectionIndex << 16u,
                    scatteringsOf(r.chosen.pathId) | shifts.x << 16u | shifts.y << 24u));
        STORE(Inspections, row + 1u,
              uvec4(floatBitsToUint(vec3(weightSum, target, weight)), FETCH_WORD(HistoryConfidences, pixel)));
    }
}
