// The shift maps: random replay, reconnection, and hybrid, which does one after the other (reconnection.glsl). All reservoirs
// whose samples have one seed are shifted in one walk: they share the prefix and whether the reconnection vertex is seen.
//
// What a sample knows of its path behind x_r holds in the world in which it was walked. Between frames that show different
// ones a second walk begins at x_r, where its triangle is by now: it leaves in the sample's direction and goes on by the
// sample's random numbers. So the measure is preserved as by other shifts, and the sample knows what holds now.
#ifndef SHADERS_PATH_SHIFT_GLSL
#define SHADERS_PATH_SHIFT_GLSL

#define DEFERS_SHADOW_RAYS
#include "path/domain.glsl"
#include "path/walk.glsl"

PathSample moving[MAX_RESERVOIRS];
vec3 arrived[MAX_RESERVOIRS];
uint outcome[MAX_RESERVOIRS]; // SHIFT_*
uint open = 0u;               // bit c: reservoir c of the group is still under way
PathSeed groupSeed;
uint joiningRays = 0u;
uint shiftOutcomes[SHIFT_OUTCOMES] = uint[SHIFT_OUTCOMES](0u, 0u, 0u, 0u, 0u, 0u);

// What has arrived counts only if a shadow ray is not blocked. They are traced after all walks, so that lanes trace theirs
// together wherever on their walks they asked. Of the reservoirs that wait for the same ray the first one holds it.
struct Pending {
    ShadowRay ray;
    uint who;     // bit c: reservoir c waits for it; none: no ray
    uint outcome; // theirs if it is blocked
};
const Pending NOTHING_PENDING = Pending(ShadowRay(Ray(vec3(0.0), vec3(0.0), 0.0), 0u), 0u, SHIFT_ENDED);
const uint PENDING_COUNT = BETWEEN_WORLDS ? 2u * RESERVOIR_COUNT : RESERVOIR_COUNT; // used: to x_r, then to light behind it
Pending pending[2u * MAX_RESERVOIRS];

void waitFor(ShadowRay ray, uint who, uint outcomeIfBlocked, uint firstPending)
{
    for (uint i = 0u; i < PENDING_COUNT; ++i)
        if (who != 0u && firstPending + uint(findLSB(who)) == i) pending[i] = Pending(ray, who, outcomeIfBlocked);
}

void tracePending()
{
    uint left = 0u;
    for (uint i = 0u; i < PENDING_COUNT; ++i) left |= pending[i].who != 0u ? 1u << i : 0u;
    LOOP_BEGIN(left != 0u)
        Pending next;
        PICK(next, pending, PENDING_COUNT, findLSB(left));
        bool blocked = left != 0u && isBlocked(next.ray);
        for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
            if (!blocked || (next.who & (1u << c)) == 0u) continue;
            arrived[c] = vec3(0.0);
            outcome[c] = next.outcome;
        }
        left &= left - 1u;
    LOOP_END(left != 0u)
}

// The second walk, for the reservoirs of the group whose paths scatter on at x_r.
uint joinedSurface = 0u; // bit c: reservoir c waits for it; always 0 but between worlds
bool resumed = false;    // this is it
vec3 joinedPrefix;       // what their paths carry to x_r
float joinedArrival;     // p_(r-1) G
Reconnection joinedAt;   // x_r
vec3 joinedFrom;         // direction to x_(r-1)
Bsdf onward;             // of x_r

bool isOpen(uint c) { return (open & (1u << c)) != 0u; }

void settle(uint c, uint what, vec3 f)
{
    open &= ~(1u << c);
    outcome[c] = what;
    arrived[c] = f;
}

bool wants(uint pathId)
{
    bool wanted = false;
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c)
        wanted = wanted || (isOpen(c) && (resumed || moving[c].reconnectionIndex == 0u) && moving[c].pathId == pathId);
    return wanted;
}

bool goesOn(uint k)
{
    if (SHIFT_MAP == SHIFT_RECONNECTION && !resumed) return false; // all is settled at x_1
    bool more = false;
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        uint r = moving[c].reconnectionIndex;
        bool deeper = resumed || r == 0u ? moving[c].pathId > makePathId(k, BY_LIGHT) : r > k + 1u;
        more = more || (isOpen(c) && deeper);
    }
    return more;
}

// What follows x_r when it scatters on, of path y: the last factors of f(T Y). `at` is the scattering at x_r, `departure` the
// density with which it leaves.
vec3 afterReconnection(PathSample y, Bsdf at, out float departure)
{
    Reconnection r = y.reconnection;
    vec3 f = evaluate(at, r.direction * at.frame, r.direction, departure);
    if (f == vec3(0.0)) return vec3(0.0);
    float weight = 1.0; // what is left of the MIS weight and depends on x_(r-1)
    if (scatteringsOf(y.pathId) == y.reconnectionIndex) {
        if (techniqueOf(y.pathId) == BY_SCATTER) weight = departure / (departure + r.lightPdf);
        else if (r.lightPdf >= 0.0) weight = 1.0 / (r.lightPdf + departure);
    }
    return f * r.suffix * weight;
}

// The rest of a path that was joined to x_r, walked again: `suffix` lacks the scattering at x_r.
void emitResumed(uint pathId, vec3 suffix, Ending e)
{
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        if (!isOpen(c) || moving[c].pathId != pathId) continue;
        moving[c].reconnection = suffixOf(moving[c].reconnection, moving[c].reconnectionIndex == scatteringsOf(pathId), suffix, e);
        float departure;
        vec3 f = joinedPrefix * afterReconnection(moving[c], onward, departure);
        moving[c].density = densityOf(moving[c].reconnectionIndex, pathId, joinedArrival, departure);
        settle(c, f == vec3(0.0) ? SHIFT_DARK : SHIFT_DONE, f);
    }
}

void emit(uint pathId, vec3 f, Ending e)
{
    if (BETWEEN_WORLDS && resumed) {
        emitResumed(pathId, f, e);
        return;
    }
    bool joinedEarlier = techniqueOf(pathId) == BY_SCATTER && lightVertex.index != 0u;
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        if (!isOpen(c) || moving[c].reconnectionIndex != 0u || moving[c].pathId != pathId) continue;
        settle(c, joinedEarlier ? SHIFT_JOINED_EARLIER : SHIFT_DONE, joinedEarlier ? vec3(0.0) : f);
    }
}

void emitUnlessBlocked(uint pathId, vec3 f, Ending e, ShadowRay ray)
{
    uint before = open;
    emit(pathId, f, e);
    waitFor(ray, before & ~open, SHIFT_ENDED, PENDING_COUNT - RESERVOIR_COUNT);
}

// Joins x = x_(r-1) to the reconnection vertices of all paths of the group that reconnect next.
void join(Vertex x)
{
    uint joining = 0u;
    uint joined = 0u;
    Reconnection r;
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        if (!isOpen(c) || moving[c].reconnectionIndex != x.k + 1u) continue;
        joining |= 1u << c;
        r = moving[c].reconnection; // paths of one seed and one r have the same x_r
    }
    if (joining != 0u) {
        bool infinite = HAS_ENVIRONMENT && r.triangle == NO_HIT;
        uint triangle = infinite ? 0u : r.triangle;
        vec3 position = hitPosition(triangle, r.barycentric);
        vec3 origin = departure(x.s, infinite ? r.direction : position - x.s.position);
        vec3 d = position - origin;
        float squared = dot(d, d);
        float distance = infinite ? RAY_MAX : sqrt(squared);
        vec3 direction = infinite ? r.direction : squared > 0.0 ? d / distance : x.s.geometricNormal; // not joinable at 0
        Surface at = loadSurface(triangle, r.barycentric, -direction);
        float geometry = infinite ? 1.0 : abs(dot(at.geometricNormal, direction)) / squared;
        float pdf;
        vec3 f = evaluate(x.bsdf, direction * x.bsdf.frame, direction, pdf);
        bool scatters = f != vec3(0.0);
        // x_r as a light, and as a surface that scatters on: the same for all paths, evaluated once.
        vec4 environment = loadEnvironment(direction);
        vec3 radiance = infinite ? environment.rgb : at.emission;
        float lightDensity = infinite ? environmentPdf(environment) : lightPdf(at, origin, direction);
        vec3 asLight = radiance == vec3(0.0) || !scatters ? vec3(0.0) : radiance * (pdf / (pdf + lightDensity));
        Bsdf bsdf = makeBsdf(at, -direction);
        bool endsHere = absorbs(bsdf);
        bool exists = !TWO_WORLDS || infinite || at.area > 0.0; // else it is hidden, or a point, in this world
        bool lightJoins = joinsLight(x.k + 1u, x.s, position, distance, pdf * geometry) && exists;
        bool surfaceJoins = lightJoins && scattersWidely(at);
        float measure = infinite ? geometry : geometry * unitOfArea(at);
        vec3 prefix = x.throughput * f * measure;
        for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
            if ((joining & (1u << c)) == 0u) continue;
            bool toLight = scatteringsOf(moving[c].pathId) == x.k;
            bool joinable = toLight ? lightJoins : surfaceJoins;
            if (BETWEEN_WORLDS && !toLight && surfaceJoins && scatters && !endsHere) {
                joinedSurface |= 1u << c;
                continue;
            }
            vec3 moved = vec3(0.0);
            float departure = 1.0;
            if (joinable && scatters && (toLight || !endsHere))
                moved = prefix * (toLight ? asLight : afterReconnection(moving[c], bsdf, departure));
            moving[c].density = densityOf(x.k + 1u, moving[c].pathId, pdf * measure, departure);
            settle(c, !joinable ? SHIFT_NOT_JOINABLE : moved == vec3(0.0) ? SHIFT_DARK : SHIFT_DONE, moved);
            joined |= moved != vec3(0.0) ? 1u << c : 0u;
        }
        if (BETWEEN_WORLDS && joinedSurface != 0u) {
            open &= ~joinedSurface;
            joined |= joinedSurface;
            joinedPrefix = prefix;
            joinedArrival = pdf * measure;
            joinedAt = r;
            joinedFrom = -direction;
            firstVertex = x.k + 1u;
        }
        if (joined != 0u) {
            ++joiningRays;
            waitFor(shadowRay(x.s, infinite, at.position, at.geometricNormal, at.offset, direction,
                              pathRandom(groupSeed, x.k, PURPOSE_SCATTER).w),
                    joined, SHIFT_HIDDEN, 0u);
        }
    }
}

bool visit(Vertex x)
{
    if (BETWEEN_WORLDS && resumed) return open != 0u;
    if (reconnectionVertex.index != 0u) { // at x_k already: whatever is still under way reconnects later in its own domain
        for (uint c = 0u; c < RESERVOIR_COUNT; ++c)
            if (isOpen(c)) settle(c, SHIFT_JOINED_EARLIER, vec3(0.0));
        return false;
    }
    if (SHIFT_MAP != SHIFT_REPLAY) join(x);
    return open != 0u;
}

// The samples of a pixel's reservoirs, shifted into domain `to`: f[c] = f(T Y_c), 0 where T is not defined.
void shiftInto(Domain to, Reservoir r[MAX_RESERVOIRS], out vec3 f[MAX_RESERVOIRS])
{
    uint left = 0u;
    for (uint c = 0u; c < MAX_RESERVOIRS; ++c) f[c] = vec3(0.0);
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        moving[c] = r[c].chosen;
        if (!(r[c].weightSum > 0.0)) continue;
        // Reconnection alone moves paths that end on a sampled light at once, and those that reconnect at x_2.
        bool replays = moving[c].reconnectionIndex == 0u && moving[c].pathId != makePathId(1u, BY_LIGHT);
        if (SHIFT_MAP == SHIFT_RECONNECTION && replays) {
            ++shiftOutcomes[SHIFT_NOT_JOINABLE];
            continue;
        }
        left |= 1u << c;
    }
    uint all = left;
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        arrived[c] = vec3(0.0);
        outcome[c] = SHIFT_ENDED;
    }
    for (uint i = 0u; i < PENDING_COUNT; ++i) pending[i] = NOTHING_PENDING;
    footprint = to.footprint;
    Surface first = loadSurface(to.triangle, to.barycentric, to.wo); // x_1 of all groups
    Bsdf firstBsdf = makeBsdf(first, to.wo);
    LOOP_BEGIN(left != 0u || (BETWEEN_WORLDS && joinedSurface != 0u))
        Surface begin = first;
        Bsdf beginBsdf = firstBsdf;
        vec3 wo = to.wo;
        resumed = BETWEEN_WORLDS && joinedSurface != 0u;
        if (!resumed) {
            PathSample next;
            PICK(next, moving, RESERVOIR_COUNT, findLSB(left));
            groupSeed = next.seed;
            uint group = 0u;
            for (uint c = 0u; c < RESERVOIR_COUNT; ++c)
                if ((left & (1u << c)) != 0u && moving[c].seed == groupSeed) group |= 1u << c;
            left &= ~group;
            open = group;
            firstVertex = 1u;
            firstDirection = vec3(0.0);
        } else {
            open = joinedSurface;
            joinedSurface = 0u;
            for (uint c = 0u; c < RESERVOIR_COUNT; ++c) // all that scatter on at x_r leave it alike
                if (isOpen(c) && moving[c].pathId != makePathId(firstVertex, BY_LIGHT)) firstDirection = moving[c].reconnection.direction;
            wo = joinedFrom;
            begin = loadSurface(joinedAt.triangle, joinedAt.barycentric, wo);
            onward = makeBsdf(begin, wo);
            beginBsdf = onward;
        }
        walk(begin, beginBsdf, wo, groupSeed);
    LOOP_END(left != 0u || (BETWEEN_WORLDS && joinedSurface != 0u))
    tracePending();
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        if ((all & (1u << c)) == 0u) continue;
        f[c] = finiteOrCounted(arrived[c], STAGE);
        for (uint i = 0u; i < SHIFT_OUTCOMES; ++i) shiftOutcomes[i] += outcome[c] == i ? 1u : 0u; // no indexed store
    }
}

// The sample that was shifted last from reservoir c: what holds of it in the domain where it is now.
PathSample renewed(uint c) { return moving[c]; }

void countShifts()
{
    addToCounter(COUNTER_REPLAY, tracedRays + shadowRays);
    addToCounter(COUNTER_RECONNECTION, joiningRays);
    for (uint i = 0u; i < SHIFT_OUTCOMES; ++i) addToCounter(COUNTER_SHIFT + i, shiftOutcomes[i]);
}

#endif
