#version 460
#extension GL_GOOGLE_include_directive : require
// Stage 4. Merges the neighbors' reservoirs (defensive pairwise MIS), resolves the color (shown: of the chosen samples, or of all with their weights), and leaves the history of the
// next frame. With no neighbors it only resolves and hands on.
#define STAGE STAGE_SPATIAL_GATHER
#include "lib/frame.glsl"
#include "lib/table.glsl"
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

// How often do the reservoirs of a pixel agree? What they share is shifted once.
void countTrees(Reservoir r[MAX_RESERVOIRS])
{
    if (RESERVOIR_COUNT == 1u) return;
    bool held = true;
    uint trees = 0u;
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        held = held && r[c].weightSum > 0.0;
        bool isNew = true;
        for (uint before = 0u; before < c; ++before) isNew = isNew && r[before].chosen.seed != r[c].chosen.seed;
        trees += isNew ? 1u : 0u;
    }
    addToCounter(COUNTER_HELD, held ? 1u : 0u);
    addToCounter(COUNTER_TREES, held ? trees : 0u);
}

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= frame.width || at.y >= frame.height) return;
    uint pixel = at.y * frame.width + at.x;

    Reservoir r[MAX_RESERVOIRS];
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) r[c] = loadReservoirsHead(pixel, c);
    float confidence = float(FETCH_WORD(Confidences, pixel)); // c_i
    float neighborConfidence = 0.0;                            // M_n
    for (uint slot = 0u; slot < frame.neighborCount; ++slot) {
        uint neighbor = neighborOf(pixel, slot);
        if (neighbor != NO_NEIGHBOR) neighborConfidence += float(FETCH_WORD(Confidences, neighbor));
    }
    // Pairwise MIS in complement form: S' = S_i + sum over j of (w_j - eps_j S_i), where eps_j is the part of the own sample's
    // MIS weight that neighbor j takes. Equal domains change nothing, to the last bit, and what rounding takes is carried on.
    Reservoir merged[MAX_RESERVOIRS];
    uint lender[MAX_RESERVOIRS]; // whose sample is chosen; paths are loaded once that is settled
    precise float change[MAX_RESERVOIRS];
    float kept[MAX_RESERVOIRS]; // MIS weight of the own sample
    vec3 weighted = vec3(0.0);  // sum over j of w_j chi(T y_j)
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        merged[c] = EMPTY;
        lender[c] = pixel;
        change[c] = r[c].carry;
        kept[c] = 1.0;
    }
    for (uint slot = 0u; slot < frame.neighborCount; ++slot) {
        uint neighbor = neighborOf(pixel, slot);
        if (neighbor == NO_NEIGHBOR) continue;
        float part = float(FETCH_WORD(Confidences, neighbor)) / (confidence + neighborConfidence); // c_j / M
        float u = decisionFloat(decisionRandom(pixel, STREAM_SPATIAL + slot).x);                    // one for all reservoirs
        for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
            Reservoir other = loadReservoirsHead(neighbor, c);
            vec3 fHere = shiftedFrom(neighbor, slot, c);
            float a = ratio(targetOf(c, fHere), targetOf(c, other.f));
            float b = ratio(targetOf(c, shiftedFrom(pixel, slot, c)), targetOf(c, r[c].f));
            precise float weight = (other.weightSum + other.carry) * part * (neighborConfidence / confidence) *
                                   share(confidence, a, neighborConfidence); // w_j
            precise float taken = part * share(neighborConfidence, b, confidence); // eps_j
            change[c] += weight - taken * r[c].weightSum;
            kept[c] -= taken;
            if (COLOR_READING == COLOR_WEIGHTED) weighted += weight * colorOf(c, fHere);
            if (!consider(merged[c], weight, u)) continue;
            merged[c].chosen = other.chosen;
            merged[c].f = fHere;
            lender[c] = neighbor;
        }
    }
    float u = decisionFloat(decisionRandom(pixel, STREAM_SPATIAL + frame.neighborCount).x);
    vec3 chosen = vec3(0.0);
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        if (COLOR_READING == COLOR_WEIGHTED)
            weighted += (r[c].weightSum * kept[c] + r[c].carry) * colorOf(c, r[c].f);
        if (merged[c].weightSum > 0.0 && !consider(merged[c], r[c].weightSum * kept[c], u)) {
            r[c].chosen = merged[c].chosen;
            r[c].f = merged[c].f;
        } else {
            lender[c] = pixel;
        }
        r[c].chosen.reconnection = loadReservoirsPath(lender[c], c);
        precise float total = r[c].weightSum + change[c];
        precise float carry = change[c] - (total - r[c].weightSum);
        r[c].weightSum = total;
        r[c].carry = carry;
        chosen += resolved(c, r[c]);
    }
    countTrees(r);
    storeHistory(pixel, r);
    historyConfidences[pixel] = uint(confidence + neighborConfidence);
    vec3 light = chosen;
    // Without neighbors nothing was merged here: the merge before stands.
    if (COLOR_READING == COLOR_WEIGHTED) light = neighborConfidence > 0.0 ? weighted : colorIn(MergedColor, pixel);
    STORE(Color, pixel, rowOf(finiteOrCounted(colorIn(Color, pixel) + light, STAGE)));
}
