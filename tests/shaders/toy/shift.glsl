// In place of path/shift.glsl: the toy's shifts.
#include "domain.glsl"

PathSample moving[MAX_RESERVOIRS];

vec3 moved(ToyDomain d, PathSample y)
{
    Reconnection kept = y.reconnection;
    if (y.reconnectionIndex != 0u)
        return canBeKept(d, kept.direction.y) ? value(d, kept.barycentric.x, kept.suffix, kept.lightPdf) : vec3(0.0);
    if (SHIFT_MAP == SHIFT_RECONNECTION) return vec3(0.0);
    float x = drawn(d, y.seed, y.pathId);
    if (canBeKept(d, x)) return vec3(0.0); // a path of this domain would be kept: not invertible
    return value(d, x, suffixOf(y.pathId, x), ending(x)) / density(d, x);
}

void shiftInto(Domain to, Reservoir r[MAX_RESERVOIRS], out vec3 f[MAX_RESERVOIRS])
{
    for (uint c = 0u; c < MAX_RESERVOIRS; ++c) f[c] = vec3(0.0);
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        moving[c] = r[c].chosen;
        if (moving[c].reconnectionIndex != 0u) moving[c].density = density(to.toy, moving[c].reconnection.direction.y);
        if (r[c].weightSum > 0.0) f[c] = finiteOrCounted(moved(to.toy, r[c].chosen), STAGE);
    }
}

PathSample renewed(uint c) { return moving[c]; }
void countShifts() {}
