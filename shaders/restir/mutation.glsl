// A Metropolis-Hastings step on the samples of history, before they are merged: history's sums S converge, but its samples Y
// stay for as long as nothing better comes. A new path x of history's domain is a proposal that knows nothing of Y, and takes
// its place with probability
//     min(1, F(x) q(kind of Y) / (F(Y) q(kind of x))),   F = <target, f> in primary sample space,
// where the kind of a path is its length and technique, and q(kind) the probability that this kind is proposed: of a walk's
// many paths one, picked before they are known. S stays, and so does E[S delta_Y], which is all that a reservoir promises:
// this step leaves the target's density as it is. Before the merge, since afterwards Y would depend on x. (DECISIONS.md,
// "Mutations of history's samples".)
//
// Includers have tables History and HistoryPaths, in which samples are replaced.
#ifndef SHADERS_RESTIR_MUTATION_GLSL
#define SHADERS_RESTIR_MUTATION_GLSL

#include "restir/path_id.glsl"
#include "restir/estimator.glsl"
#include "restir/reservoir_store.glsl"
LOAD_RESERVOIRS(History, History, HistoryPaths)
STORE_RESERVOIRS(History, History, HistoryPaths)

Reservoir mutated[MAX_RESERVOIRS];
float threshold[MAX_RESERVOIRS]; // F(x) must be above it
uint sought[MAX_RESERVOIRS];     // the kind that is proposed to reservoir c; 0: none
uint accepted = 0u;              // bit c: a sample was replaced

// Half of the proposals are of Y's own kind, which is accepted most often; with the other half kinds change, too: paths of at
// least k scattering events with probability 1 / k.
uint pickKind(uint own, uvec2 random)
{
    if ((random.x & 1u) == 0u) return own;
    uint k = min(uint(1.0 / (1.0 - unitFloat(random.y))), MAX_BOUNCES);
    return makePathId(k, random.x >> 1u & 1u);
}
float probabilityOf(uint kind) // of the picks that are not Y's own; techniques are equal
{
    float k = float(scatteringsOf(kind));
    return scatteringsOf(kind) < MAX_BOUNCES ? 1.0 / k - 1.0 / (k + 1.0) : 1.0 / k;
}

void beginMutation(uint pixel)
{
    loadHistory(pixel, mutated);
    uvec4 random = decisionRandom(pixel, STREAM_MUTATION); // the same for all reservoirs
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        PathSample y = mutated[c].chosen;
        sought[c] = mutated[c].weightSum > 0.0 ? pickKind(y.pathId, random.yz) : 0u;
        float odds = sought[c] == y.pathId ? 1.0 : probabilityOf(sought[c]) / probabilityOf(y.pathId);
        threshold[c] = decisionFloat(random.x) * (targetOf(c, mutated[c].f) / y.density) * odds;
    }
}

// f in primary sample space, and in the measure of reservoirs.
void propose(PathSample x, vec3 f, vec3 stored)
{
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        if (x.pathId != sought[c] || !(targetOf(c, f) > threshold[c])) continue;
        mutated[c].chosen = x;
        mutated[c].f = stored;
        accepted |= 1u << c;
    }
}

void endMutation(uint pixel)
{
    uint proposed = 0u;
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) proposed += sought[c] != 0u ? 1u : 0u;
    addToCounter(COUNTER_PROPOSED, proposed);
    addToCounter(COUNTER_ACCEPTED, uint(bitCount(accepted)));
    if (accepted != 0u) storeHistory(pixel, mutated);
}

#endif
