#version 460
#extension GL_GOOGLE_include_directive : require
// Stage 4. Merges the neighbors' reservoirs, resolves the color (of the chosen samples, or of all with their weights), and
// leaves the history of the next frame. With no neighbors it only resolves and hands on.
#define STAGE STAGE_SPATIAL_GATHER
#include "lib/frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
TABLE(SET_PASS, 0, Reservoirs);
TABLE(SET_PASS, 1, ReservoirPaths);
TABLE(SET_PASS, 2, Confidences);
TABLE(SET_PASS, 3, Shifted);
TABLE(SET_PASS, 4, MergedColor);
TABLE_OUT(SET_PASS, 5, History);
TABLE_OUT(SET_PASS, 6, HistoryPaths);
TABLE_INOUT(SET_PASS, 7, Color);
layout(set = SET_PASS, binding = 8, std430) writeonly buffer HistoryConfidences { uint historyConfidences[]; };
TABLE_OUT(SET_PASS, 9, HistoryColor);

#include "restir/estimator.glsl"
#include "restir/reservoir_store.glsl"
LOAD_RESERVOIRS(Reservoirs, Reservoirs, ReservoirPaths)
STORE_RESERVOIRS(History, History, HistoryPaths)
LOAD_SHIFTED(Shifted)

// NO_NEIGHBOR, too, where rounding made the two of a pair differ on whether they are alike.
uint neighborOf(uint pixel, uint slot)
{
    uint neighbor = neighborIn(pixel, slot);
    return neighbor != NO_NEIGHBOR && neighborIn(neighbor, slot) == pixel ? neighbor : NO_NEIGHBOR;
}

float confidenceOfNeighbors(uint pixel)
{
    float sum = 0.0;
    for (uint slot = 0u; slot < frame.neighborCount; ++slot) {
        uint neighbor = neighborOf(pixel, slot);
        if (neighbor != NO_NEIGHBOR) sum += float(FETCH_WORD(Confidences, neighbor));
    }
    return sum;
}

void handOn(uint pixel, Reservoir r[MAX_RESERVOIRS], uint confidence)
{
    countTrees(r);
    storeHistory(pixel, r);
    historyConfidences[pixel] = confidence;
}

// What a pixel shows: what it sees directly, and `color`. With that as A, and the albedo, for the next frame.
void show(uint pixel, vec3 color, uint albedo)
{
    if (COLOR_READING == COLOR_VARIATE)
        STORE(HistoryColor, pixel, rowOf(finiteOrCounted(color, STAGE), albedo));
    STORE(Color, pixel, rowOf(finiteOrCounted(colorIn(Color, pixel) + color, STAGE)));
}

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= frame.width || at.y >= frame.height) return;
    uint pixel = at.y * frame.width + at.x;

    float confidence = float(FETCH_WORD(Confidences, pixel)); // c_i
    float neighborConfidence = confidenceOfNeighbors(pixel);  // M_n
    Reservoir r[MAX_RESERVOIRS];
    PairwiseMerge merge[MAX_RESERVOIRS];
    uint lender[MAX_RESERVOIRS]; // whose sample is chosen; paths are loaded once that is settled
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        r[c] = loadReservoirsHead(pixel, c);
        merge[c] = beginMerge(r[c], confidence, neighborConfidence);
    }
    uvec4 before = COLOR_READING != COLOR_CHOSEN ? FETCH(MergedColor, pixel) : uvec4(0u); // color of the merge before; albedo
    vec3 weighted = vec3(0.0); // sum of w chi over all that is merged; of COLOR_VARIATE: A' - A_i
    for (uint slot = 0u; slot < frame.neighborCount; ++slot) {
        uint neighbor = neighborOf(pixel, slot);
        if (neighbor == NO_NEIGHBOR) continue;
        float otherConfidence = float(FETCH_WORD(Confidences, neighbor)); // c_j
        float u = decisionNumber(pixel, STREAM_SPATIAL + slot);           // one for all reservoirs
        float beta = equalShare(merge[0], otherConfidence);               // beta_j
        uvec4 otherColor = COLOR_READING == COLOR_VARIATE ? FETCH(MergedColor, neighbor) : uvec4(0u); // A_j
        vec3 k = albedoRatio(before.w, otherColor.w);
        if (COLOR_READING == COLOR_VARIATE) weighted += beta * (k * colorOfRow(otherColor) - colorOfRow(before));
        for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
            Reservoir other = loadReservoirsHead(neighbor, c);
            vec3 fHere = shiftedFrom(neighbor, slot, c);
            float a = ratio(targetOf(c, fHere), targetOf(c, other.f));
            float b = ratio(targetOf(c, shiftedFrom(pixel, slot, c)), targetOf(c, r[c].f));
            float weight; // w_j
            bool chosen = mergeNeighbor(merge[c], r[c], other, a, b, otherConfidence, u, weight);
            if (COLOR_READING == COLOR_WEIGHTED) weighted += weight * colorOf(c, fHere);
            if (COLOR_READING == COLOR_VARIATE)
                weighted += beta * colorDifference(c, r[c], shiftedFrom(pixel, slot, c), other, fHere,
                                                   vec2(confidence, otherConfidence), k);
            if (!chosen) continue;
            merge[c].neighbors.chosen = other.chosen;
            merge[c].neighbors.chosen.density = densityFrom(neighbor, slot, c);
            merge[c].neighbors.f = fHere;
            lender[c] = neighbor;
        }
    }
    float u = decisionNumber(pixel, STREAM_SPATIAL + frame.neighborCount);
    vec3 color = vec3(0.0); // of the chosen samples
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        if (COLOR_READING == COLOR_WEIGHTED) weighted += (r[c].weightSum * merge[c].kept + r[c].carry) * colorOf(c, r[c].f);
        if (endMerge(merge[c], r[c], u)) {
            r[c].chosen = merge[c].neighbors.chosen;
            r[c].f = merge[c].neighbors.f;
        } else {
            lender[c] = pixel;
        }
        r[c].chosen.reconnection = loadReservoirsPath(lender[c], c);
        color += resolved(c, r[c]);
    }
    handOn(pixel, r, uint(confidence + neighborConfidence));
    // Without neighbors nothing was merged here: the merge before stands.
    if (COLOR_READING == COLOR_VARIATE) color = colorOfRow(before) + weighted;
    if (COLOR_READING == COLOR_WEIGHTED) color = neighborConfidence > 0.0 ? weighted : colorOfRow(before);
    show(pixel, color, before.w);
}
