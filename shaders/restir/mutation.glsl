// A Metropolis-Hastings step on the samples of history, before they are merged: history's sums S converge, but its samples Y
// stay for as long as nothing better comes. A new path x of history's domain and of Y's kind (length and technique) is a
// proposal that knows nothing of Y, and takes its place with probability
//     min(1, F(x) / F(Y)),   F = <target, f> in primary sample space.
// S stays, and so does E[S delta_Y], which is all that a reservoir promises: this step leaves the target's density as it is.
// Before the merge, since afterwards Y would depend on x. (After ../docs/DECISIONS.md, "Mutations of history's samples".)
//
// Includers have tables History and HistoryPaths, in which samples are replaced.
#ifndef SHADERS_RESTIR_MUTATION_GLSL
#define SHADERS_RESTIR_MUTATION_GLSL

#include "restir/estimator.glsl"
#include "restir/reservoir_store.glsl"
LOAD_RESERVOIRS(History, History, HistoryPaths)
STORE_RESERVOIRS(History, History, HistoryPaths)

Reservoir mutated[MAX_RESERVOIRS];
float threshold[MAX_RESERVOIRS]; // u F(Y_c): F(x) must be above it
uint proposed = 0u;              // bit c: a sample waits for a proposal
uint accepted = 0u;              // bit c: it was replaced

bool awaits(uint c, uint pathId) { return (proposed & (1u << c)) != 0u && mutated[c].chosen.pathId == pathId; }

void beginMutation(uint pixel)
{
    loadHistory(pixel, mutated);
    float u = decisionNumber(pixel, STREAM_MUTATION); // one for all reservoirs
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        threshold[c] = u * (targetOf(c, mutated[c].f) / mutated[c].chosen.density);
        if (mutated[c].weightSum > 0.0) proposed |= 1u << c;
    }
}

// f in primary sample space, and in the measure of reservoirs.
void propose(PathSample x, vec3 f, vec3 stored)
{
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        if (!awaits(c, x.pathId) || !(targetOf(c, f) > threshold[c])) continue;
        mutated[c].chosen = x;
        mutated[c].f = stored;
        accepted |= 1u << c;
    }
}

void endMutation(uint pixel)
{
    addToCounter(COUNTER_PROPOSED, uint(bitCount(proposed)));
    addToCounter(COUNTER_ACCEPTED, uint(bitCount(accepted)));
    if (accepted != 0u) storeHistory(pixel, mutated);
}

#endif
