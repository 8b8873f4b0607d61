// Reservoirs and the three ways to merge samples into them: consider, mergeHistory, mergeNeighbor. Knows neither scenes nor
// buffers nor colors. Equations and algorithms by number alone, in all shaders, are those of "RGB ReSTIR" (README.md), which
// stands on Lin et al. 2022, "Generalized Resampled Importance Sampling" (doi 10.1145/3528223.3530158).
//
// A reservoir holds (Y, f(Y), S): a path, its contribution in the domain (pixel and frame) where it now lives, and the sum
// of weights S: an unbiased estimate of the integral of the target p_hat = <target, f>. W = S / p_hat(Y) is never formed;
// merges need only ratios rho = p_hat'(T Y) / p_hat(Y) of the two domains. (Densities are taken in a measure that shifts
// preserve, so |T'| = 1: path/reconnection.glsl.)
#ifndef SHADERS_RESTIR_RESERVOIR_GLSL
#define SHADERS_RESTIR_RESERVOIR_GLSL

#include "lib/lanes.glsl"
#include "lib/random.glsl"

// From vertex x_r on a reconnected path is kept as it is: what shifts need to know of that part.
struct Reconnection {
    uint triangle;    // of x_r; NO_HIT: x_r is the environment in `direction`
    vec2 barycentric; // of x_r
    float lightPdf;   // of the path's light by the other technique, solid angle at x_r; 0: no weight depends on x_(r-1)
    vec3 direction;   // x_r -> x_(r+1), unit
    vec3 suffix;      // radiance that arrives at x_r from there, over the densities that drew it
};

// One path of a path tree, by the numbers that drew it. Opaque to resampling, which only moves it about.
struct PathSample {
    PathSeed seed;
    uint pathId;            // which path of the tree: restir/path_id.glsl
    uint reconnectionIndex; // r of the reconnection vertex x_r; 0: the whole path is replayed
    Reconnection reconnection; // when reconnectionIndex > 0
    float density;             // f(Y) over this is its contribution in primary sample space; kept for mutations alone
};

struct Reservoir {
    PathSample chosen;  // Y
    vec3 f;             // f(Y) in this domain
    float weightSum;    // S
    float carry;        // what rounding took from S: the sum is weightSum + carry
};

const PathSample NO_SAMPLE =
    PathSample(PathSeed(0u, 0u), 0u, 0u, Reconnection(0u, vec2(0.0), 0.0, vec3(0.0), vec3(0.0)), 1.0);
const Reservoir EMPTY = Reservoir(NO_SAMPLE, vec3(0.0), 0.0, 0.0);

// Algorithm 1, update: true when the new sample of weight w is the one to keep.
bool consider(inout Reservoir r, float w, float u)
{
    r.weightSum += w;
    return u * r.weightSum < w;
}

// rho. A reservoir whose sample has no target is empty: its S is 0, and so is everything multiplied with it.
float ratio(float targetThere, float targetHere) { return targetHere > 0.0 ? targetThere / targetHere : 0.0; }

// a x / (a x + b) for x in [0, inf], b > 0: saturates where a x would overflow.
float share(float a, float x, float b) { return x > 1.0 ? a / (a + b / x) : a * x / (a * x + b); }

// b / (a x + b), the rest.
float rest(float a, float x, float b) { return x > 1.0 ? (b / x) / (a + b / x) : b / (a * x + b); }

// x times that rest.
float restTimes(float a, float x, float b) { return x > 1.0 ? b / (a + b / x) : x * b / (a * x + b); }

// Eqs. 9 and 13 for canonical sample and history: `here` stands in its own domain, `history` in another; rho is the ratio
// of targets (other over own domain) of here's sample, historyRho likewise (here's over its own) of history's sample.
// True when history's sample is chosen: the caller replaces sample and f. `weight` is w_n, of here's sample; the rest of the
// sum is w_h.
//
// Summing thousands of frames with c / (c + 1) S + 1 / (c + 1) S_n loses up to 1e-2 to rounding (M_c = 10^6). Hence the
// complement form: S' = v + (w_n - eps v), eps = 1 - weight of history, with the rounding of v and of the sum carried on.
bool mergeHistory(inout Reservoir here, Reservoir history, float rho, float historyRho, float confidence,
                  float historyConfidence, float u, out precise float weight)
{
    weight = here.weightSum * rest(historyConfidence, rho, confidence); // w_n
    if (historyRho == 0.0 || history.weightSum == 0.0) { // history has nothing to give, but its confidence counts
        here.weightSum = weight;
        here.carry = 0.0;
        return false;
    }
    float eps = share(confidence, historyRho, historyConfidence);
    if (confidence * historyRho <= 16.0 * historyConfidence) {
        precise float value = history.weightSum * historyRho;
        precise float roundedOff = fma(history.weightSum, historyRho, -value);
        precise float change = (weight - eps * value) + roundedOff + history.carry * historyRho * (1.0 - eps);
        here.weightSum = sumOf(value, change, here.carry);
    } else { // 1 - eps would cancel
        here.weightSum = weight + history.weightSum * (historyConfidence / confidence) * eps;
        here.carry = 0.0;
    }
    return !(u * here.weightSum < weight);
}

// Defensive pairwise MIS (Lin et al. 2022), in ratios: the merge of a pixel's own reservoir (confidence c_i) with those of its
// neighbors (c_j; together M_n, and M with the own), one after the other. a and b are the ratios rho of the neighbor's sample
// (here over there) and of the own one (there over here):
//     w_j = S_j (c_j / M) M_n a / (M_n + c_i a),    w_i = S_i (1 - sum of eps_j),    eps_j = (c_j / M) M_n b / (M_n b + c_i)
// In complement form S' = S_i + sum of (w_j - eps_j S_i): equal domains change nothing, to the last bit.
struct PairwiseMerge {
    float confidence;         // c_i
    float neighborConfidence; // M_n
    Reservoir neighbors;      // which of their samples is chosen, and the sum of w_j
    float change;             // S' - S_i, with what rounding took before
    float kept;               // m_i, MIS weight of the own sample
};

PairwiseMerge beginMerge(Reservoir own, float confidence, float neighborConfidence)
{
    return PairwiseMerge(confidence, neighborConfidence, EMPTY, own.carry, 1.0);
}

// eps_j where domains are equal.
float equalShare(PairwiseMerge m, float confidence)
{
    float total = m.confidence + m.neighborConfidence; // M
    return confidence * m.neighborConfidence / (total * total);
}

// True when the neighbor's sample is chosen among the neighbors': the caller replaces sample and f of m.neighbors. `weight`: w_j.
bool mergeNeighbor(inout PairwiseMerge m, Reservoir own, Reservoir neighbor, float a, float b, float confidence, float u,
                   out precise float weight)
{
    precise float part = confidence / (m.confidence + m.neighborConfidence); // c_j / M
    weight = (neighbor.weightSum + neighbor.carry) * part * (m.neighborConfidence / m.confidence) *
             share(m.confidence, a, m.neighborConfidence);
    precise float taken = part * share(m.neighborConfidence, b, m.confidence); // eps_j
    precise float change = m.change + (weight - taken * own.weightSum);
    m.change = change;
    m.kept -= taken;
    return consider(m.neighbors, weight, u);
}

// True when the sample chosen among the neighbors' is chosen over the own one, of weight w_i: the caller replaces sample and f.
bool endMerge(PairwiseMerge m, inout Reservoir own, float u)
{
    bool replaced = m.neighbors.weightSum > 0.0 && !consider(m.neighbors, own.weightSum * m.kept, u);
    own.weightSum = sumOf(own.weightSum, m.change, own.carry);
    return replaced;
}

#endif
