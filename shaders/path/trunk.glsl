// Where a path tree can be cut and reconnected, and what is needed for it. Part of path/walk.glsl.
//
// The reconnection vertex x_r of a path is the first x_r, r >= 2, such that x_(r-1) and x_r scatter widely and are far enough
// apart. A shift replays x_2 .. x_(r-1), joins x_(r-1) to x_r and keeps the rest (Lin et al. 2022, section 5.3). That is
// invertible only if the shifted path's first such vertex is x_r too, so both directions ask the same joins().
//
// Measure: primary sample space before x_r, area at x_r (solid angle for the environment), solid angle at x_r for x_(r+1)
// when scattering found it, primary sample space after. Shifts preserve it, so |T'| = 1, and f(Y) of a reconnecting path
// is its contribution in primary sample space times the densities p_(r-1) G (and p_r) that `arrival` and `departure` hold.
#ifndef SHADERS_PATH_TRUNK_GLSL
#define SHADERS_PATH_TRUNK_GLSL

#include "restir/path_sample.glsl"

// Hybrid: below this GGX alpha a lobe is replayed. Reconnection alone joins all but perfect mirrors.
const float JOIN_ALPHA = SHIFT_MAP == SHIFT_HYBRID ? 0.04 : DIRAC_ALPHA;
// Hybrid: x_(r-1) spreads its scattered rays around x_r over an area of 1 / arrival at least. Joined where it is smaller
// than what the pixel's path sees of x_1, a path would change more by the shift than by being drawn anew. After Lin et
// al., "ReSTIR PT Enhanced" (2026), section 4: 0.0002 of the sphere around x_1 that the camera lies on, as x_1 faces it.
const float FOOTPRINT = 0.0002 * 4.0 * PI;
// Reconnection alone: nearer than this part of their coordinates vertices have no direction left between them.
const float JOIN_DISTANCE = 9.5367431640625e-7; // 2^-20

struct Trunk {
    uint joint; // r; 0: none yet
    uint triangle;
    vec2 barycentric;
    float arrival;   // p_(r-1) G
    float departure; // p_r, of the trunk's own direction
    vec3 direction;  // x_r -> x_(r+1)
    vec3 suffix;     // throughput of the scattering events after x_r
};
const Trunk NO_TRUNK = Trunk(0u, 0u, vec2(0.0), 0.0, 0.0, vec3(0.0), vec3(1.0));
Trunk trunk;

// The last scattered ray, if the light it found can be a reconnection vertex itself.
struct LightJoint {
    bool joins;
    Hit hit;
    float arrival; // p_k G
};
LightJoint lightJoint;

// Of the domain that a walk is in: it depends on x_0 and x_1 alone. Set before the walk begins.
float footprint = 0.0;

float footprintOf(CameraUniform camera, vec3 position, vec3 normal, vec3 wo)
{
    vec3 d = position - camera.position.xyz;
    float squared = ORTHOGRAPHIC ? 4.0 * dot(camera.up.xyz, camera.up.xyz) : dot(d, d); // as seen at half a unit of height per unit of distance
    return FOOTPRINT * squared / abs(dot(normal, wo));
}

// Depends on the material alone, so that it is the same from all directions.
bool scattersWidely(Surface s)
{
    bool polished = s.specular > 0.0 || s.metallic > 0.0 || s.transmission > 0.0;
    return !polished || s.alphaG >= JOIN_ALPHA;
}

// Can x_(r-1) on `before` be joined to light at `position`? `arrival`: p_(r-1) G.
bool joinsLight(uint r, Surface before, vec3 position, float distance, float arrival)
{
    if (SHIFT_MAP == SHIFT_REPLAY || (SHIFT_MAP == SHIFT_RECONNECTION && r != 2u)) return false;
    if (!scattersWidely(before)) return false;
    if (distance == RAY_MAX) return true; // the environment
    if (SHIFT_MAP == SHIFT_HYBRID) return arrival * footprint <= 1.0;
    return distance > JOIN_DISTANCE * maxComponent(max(abs(before.position), abs(position)));
}

// Can x_(r-1) on `before` be joined to x_r on `at`, which scatters on?
bool joins(uint r, Surface before, Surface at, float distance, float arrival)
{
    return joinsLight(r, before, at.position, distance, arrival) && scattersWidely(at);
}

void joinTrunk(Vertex before, Segment to, Surface at)
{
    if (trunk.joint != 0u || !joins(before.k + 1u, before.s, at, to.distance, to.arrival)) return;
    trunk.joint = before.k + 1u;
    trunk.triangle = to.hit.triangle;
    trunk.barycentric = to.hit.barycentric;
    trunk.arrival = to.arrival;
}

void departTrunk(Vertex x, Scatter scatter)
{
    if (SHIFT_MAP == SHIFT_REPLAY || trunk.joint == 0u) return;
    if (trunk.joint == x.k) {
        trunk.departure = scatter.pdf;
        trunk.direction = scatter.direction;
    } else {
        trunk.suffix *= scatter.weight;
    }
}

void offerLight(Vertex x, Segment to, vec3 position)
{
    bool joins = trunk.joint == 0u && joinsLight(x.k + 1u, x.s, position, to.distance, to.arrival);
    lightJoint = LightJoint(joins, to.hit, to.arrival);
}

// The path just emitted as a sample; `density` turns its contribution in primary sample space into f(Y).
PathSample cutPath(PathSeed seed, uint leaf, Ending e, out float density)
{
    PathSample y = PathSample(seed, leaf, 0u, Reconnection(NO_HIT, vec2(0.0), 0.0, vec3(0.0), vec3(0.0)));
    density = 1.0;
    if (SHIFT_MAP == SHIFT_REPLAY) return y;
    bool byLight = (leaf & 1u) == BY_LIGHT;
    if (trunk.joint != 0u) {
        bool last = trunk.joint == scatteringsOf(leaf);
        y.joint = trunk.joint;
        y.reconnection = Reconnection(trunk.triangle, trunk.barycentric, last ? e.lightPdf : 0.0,
                                      last ? e.direction : trunk.direction, last ? e.radiance : trunk.suffix * e.weighted);
        density = last && byLight ? trunk.arrival : trunk.arrival * trunk.departure;
    } else if (!byLight && lightJoint.joins) {
        y.joint = scatteringsOf(leaf) + 1u;
        y.reconnection.triangle = lightJoint.hit.triangle;
        y.reconnection.barycentric = lightJoint.hit.barycentric;
        y.reconnection.direction = e.direction;
        density = lightJoint.arrival;
    }
    return y;
}

#endif
