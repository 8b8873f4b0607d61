#version 460
#extension GL_GOOGLE_include_directive : require
// Stage 2. Merges each pixel's canonical reservoirs with those of the pixel that saw the same point in the previous frame.
#define STAGE STAGE_TEMPORAL
#include "lib/frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
TABLE(SET_PASS, 1, History);
TABLE(SET_PASS, 2, HistoryPaths);
TABLE(SET_PASS, 3, HistoryConfidences);
TABLE_INOUT(SET_PASS, 4, Reservoirs);
TABLE_INOUT(SET_PASS, 5, ReservoirPaths);
TABLE_INOUT(SET_PASS, 6, MergedColor);
layout(set = SET_PASS, binding = 7, std430) buffer Confidences { uint confidences[]; };
TABLE(SET_PASS, 8, HistoryColor);

#include "shift.glsl"
#include "restir/estimator.glsl"
#include "restir/reservoir_store.glsl"
LOAD_RESERVOIRS(History, History, HistoryPaths)
LOAD_RESERVOIRS(Reservoirs, Reservoirs, ReservoirPaths)
STORE_RESERVOIRS(Reservoirs, Reservoirs, ReservoirPaths)

// f of the history's samples here, and of this pixel's samples there. In a loop, so that the walk is compiled once; the
// history's come last, so that renewed() is theirs.
void shiftBothWays(uint pixel, Domain here, uint previousPixel, Domain there, out vec3 fHere[MAX_RESERVOIRS],
                   out vec3 fThere[MAX_RESERVOIRS])
{
    uint way = 0u;
    LOOP_BEGIN(way < 2u)
        bool backward = way == 0u;
        vec3 f[MAX_RESERVOIRS];
        Reservoir subjects[MAX_RESERVOIRS];
        Domain to = there;
        if (backward) loadReservoirs(pixel, subjects);
        if (!backward) {
            to = here;
            loadHistory(previousPixel, subjects);
        }
        enterWorld(backward);
        shiftInto(to, subjects, f);
        enterWorld(false);
        if (backward) fThere = f;
        else fHere = f;
        ++way;
    LOOP_END(way < 2u)
}

// A' = beta_h (k A_h + D) + beta_n A_n, in complement form.
vec3 mergedEstimate(vec3 history, vec3 difference, vec3 news, uint confidence, uint historyConfidence, uvec3 random)
{
    float newShare = share(float(confidence), 1.0, float(min(historyConfidence, frame.colorConfidence))); // beta_n
    return roundedAtRandom(history, newShare * (news - history) + (1.0 - newShare) * difference, random);
}

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= frame.width || at.y >= frame.height) return;
    uint pixel = at.y * frame.width + at.x;

    Domain here = makeDomain(pixel, false);
    uint previousPixel;
    if (!here.seen || !reproject(here, pixel, previousPixel)) return;
    Domain there = makeDomain(previousPixel, true);
    uint historyConfidence = min(FETCH_WORD(HistoryConfidences, previousPixel), frame.maxConfidence); // Eq. 12
    if (historyConfidence == 0u || !alike(here, carriedOn(there))) return;

    vec3 fHere[MAX_RESERVOIRS];
    vec3 fThere[MAX_RESERVOIRS];
    if (!SAME_VIEW) shiftBothWays(pixel, here, previousPixel, there, fHere, fThere);

    Reservoir r[MAX_RESERVOIRS]; // only now, so that they need no registers meanwhile
    Reservoir old[MAX_RESERVOIRS];
    loadReservoirs(pixel, r);
    loadHistory(previousPixel, old);
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c)
        if (BETWEEN_WORLDS || (KEEPS_DENSITIES && !SAME_VIEW)) old[c].chosen = renewed(c);
    uint confidence = confidences[pixel];
    uvec4 random = decisionRandom(pixel, STREAM_TEMPORAL);
    float u = decisionFloat(random.x); // one for all reservoirs
    vec3 color = vec3(0.0); // COLOR_WEIGHTED: w_n chi(x) + w_h chi(T y); COLOR_VARIATE: D of the history
    uvec4 newColor = COLOR_READING == COLOR_VARIATE ? FETCH(MergedColor, pixel) : uvec4(0u);
    uvec4 oldColor = COLOR_READING == COLOR_VARIATE ? FETCH(HistoryColor, previousPixel) : uvec4(0u);
    vec3 k = albedoRatio(newColor.w, oldColor.w);
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        if (SAME_VIEW) { // every pixel sees what it saw, all shifts are identities
            fHere[c] = old[c].f;
            fThere[c] = r[c].f;
        }
        float rho = ratio(targetOf(c, fThere[c]), targetOf(c, r[c].f));
        float historyRho = ratio(targetOf(c, fHere[c]), targetOf(c, old[c].f));
        if (COLOR_READING == COLOR_VARIATE && !SAME_VIEW) // there it is 0
            color += colorDifference(c, r[c], fThere[c], old[c], fHere[c], vec2(confidence, historyConfidence), k);
        float weight; // w_n
        bool replaced = mergeHistory(r[c], old[c], rho, historyRho, float(confidence), float(historyConfidence), u, weight);
        if (COLOR_READING == COLOR_WEIGHTED) {
            float historyWeight = r[c].weightSum - weight + r[c].carry; // w_h, of the sum that does not drift
            color += weight * colorOf(c, r[c].f) + historyWeight * colorOf(c, fHere[c]);
        }
        if (!replaced) continue;
        r[c].chosen = old[c].chosen;
        r[c].f = fHere[c];
    }
    if (COLOR_READING == COLOR_VARIATE)
        color = mergedEstimate(k * colorOfRow(oldColor), color, colorOfRow(newColor), confidence, historyConfidence, random.yzw);
    if (COLOR_READING != COLOR_CHOSEN) STORE(MergedColor, pixel, rowOf(finiteOrCounted(color, STAGE), newColor.w));
    storeReservoirs(pixel, r);
    confidences[pixel] = confidence + historyConfidence;
    countShifts();
}
