// In place of path/integrand.glsl: the toy's domains and shifts.
#include "restir/reservoir.glsl"
#include "toy.glsl"

struct Domain {
    bool seen;
    ToyDomain toy;
};

Domain makeDomain(uint pixel, bool previous)
{
    ToyDomain toy = toyDomain(pixel, previous);
    return Domain(toy.seen != 0u, toy);
}

bool alike(Domain a, Domain b) { return a.seen && b.seen && abs(a.toy.likeness - b.toy.likeness) < 0.3; }

bool reproject(Domain here, uint pixel, out uint previousPixel)
{
    previousPixel = pixel;
    if (SAME_VIEW) return true;
    previousPixel = pixel / runPixels() * runPixels() + here.toy.previousPixel;
    return here.toy.previousPixel != NO_NEIGHBOR;
}

vec3 moved(ToyDomain d, PathSample y)
{
    Reconnection kept = y.reconnection;
    if (y.joint != 0u)
        return canBeKept(d, kept.direction.y) ? value(d, kept.barycentric.x, kept.suffix, kept.lightPdf) : vec3(0.0);
    if (SHIFT_MAP == SHIFT_RECONNECTION) return vec3(0.0);
    float x = drawn(d, y.seed, y.leaf);
    if (canBeKept(d, x)) return vec3(0.0); // a path of this domain would be kept: not invertible
    return value(d, x, suffixOf(y.leaf, x), ending(x)) / density(d, x);
}

void shiftInto(Domain to, Reservoir r[MAX_RESERVOIRS], out vec3 f[MAX_RESERVOIRS])
{
    for (uint c = 0u; c < MAX_RESERVOIRS; ++c) f[c] = vec3(0.0);
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c)
        if (r[c].weightSum > 0.0) f[c] = finiteOrCounted(moved(to.toy, r[c].chosen), STAGE);
}

void countShifts() {}
