// Where the paths of a tree can be reconnected, noted while it is walked, and what is needed for it.
//
// The reconnection vertex x_r of a path is the first x_r, r >= 2, such that x_(r-1) and x_r scatter widely and are far enough
// apart. A shift replays the prefix x_2 .. x_(r-1), joins x_(r-1) to x_r and keeps the rest (Lin et al. 2022, section 5.3).
// That is invertible only if the shifted path's first such vertex is x_r too, so both directions ask the same functions.
//
// Measure: primary sample space before x_r, area at x_r (solid angle for the environment), solid angle at x_r for x_(r+1)
// when scattering found it, primary sample space after. Shifts preserve it, so |T'| = 1, and f(Y) of a reconnecting path
// is its contribution in primary sample space times the densities p_(r-1) G (and p_r) that `arrival` and `departure` hold.
// In a scene that moves areas at x_r count in units of its triangle's, which may be stretched from frame to frame.
#ifndef SHADERS_PATH_RECONNECTION_GLSL
#define SHADERS_PATH_RECONNECTION_GLSL

#include "path/hooks.glsl"

// Hybrid: below this GGX alpha a lobe is replayed. Reconnection alone joins all but perfect mirrors.
const float JOIN_ALPHA = SHIFT_MAP == SHIFT_HYBRID ? 0.04 : DIRAC_ALPHA;
// Hybrid: x_(r-1) spreads its scattered rays around x_r over an area of 1 / arrival at least. Joined where it is smaller
// than this, the footprint of the walk's domain, a path would change more by the shift than by being drawn anew (after Lin
// et al. 2026, "ReSTIR PT Enhanced", section 4). Set before a walk begins.
float footprint = 0.0;
// Reconnection alone: nearer than this part of their coordinates vertices have no direction left between them.
const float JOIN_DISTANCE = 9.5367431640625e-7; // 2^-20

// A scattered ray, x_k -> x_(k+1).
struct Segment {
    Scatter scatter;
    Hit hit;
    float distance; // from where the ray departed; RAY_MAX: the environment
    float arrival;  // p_k G: density over area at x_(k+1); over solid angle for the environment
};

struct ReconnectionVertex {
    uint index;        // r; 0: there is none
    float arrival;     // p_(r-1) G
    float departure;   // p_r, of the walk's own direction
    Reconnection kept; // its suffix: throughput of the scattering events after x_r
};
const ReconnectionVertex NO_VERTEX =
    ReconnectionVertex(0u, 1.0, 1.0, Reconnection(NO_HIT, vec2(0.0), 0.0, vec3(0.0), vec3(1.0)));
ReconnectionVertex reconnectionVertex; // of the walk so far
ReconnectionVertex lightVertex;        // the light that the last scattered ray found, joinable itself or not

// What a density over area at x_r is multiplied with: the area that counts as 1.
float unitOfArea(Surface s) { return TWO_WORLDS ? s.area : 1.0; }

// Depends on the material alone, so that it is the same from all directions.
bool scattersWidely(Surface s)
{
    bool polished = s.specular > 0.0 || s.metallic > 0.0 || s.transmission > 0.0;
    return !polished || s.alphaG >= JOIN_ALPHA;
}

// Can x_(r-1) on `before` be joined to light at `position`? To a surface there, if it scatters widely, too. `arrival`: p_(r-1) G.
bool joinsLight(uint r, Surface before, vec3 position, float distance, float arrival)
{
    if (SHIFT_MAP == SHIFT_REPLAY || (SHIFT_MAP == SHIFT_RECONNECTION && r != 2u)) return false;
    if (!scattersWidely(before)) return false;
    if (distance == RAY_MAX) return true; // the environment
    if (SHIFT_MAP == SHIFT_HYBRID) return arrival * footprint <= 1.0;
    return distance > JOIN_DISTANCE * maxComponent(max(abs(before.position), abs(position)));
}

void noteArrival(Vertex before, Segment to, Surface at)
{
    uint r = before.k + 1u;
    if (reconnectionVertex.index != 0u || !joinsLight(r, before.s, at.position, to.distance, to.arrival)) return;
    if (!scattersWidely(at)) return;
    reconnectionVertex.index = r;
    reconnectionVertex.arrival = to.arrival * unitOfArea(at);
    reconnectionVertex.kept.triangle = to.hit.triangle;
    reconnectionVertex.kept.barycentric = to.hit.barycentric;
}

void noteDeparture(Vertex x, Scatter scatter)
{
    if (SHIFT_MAP == SHIFT_REPLAY || reconnectionVertex.index == 0u) return;
    if (reconnectionVertex.index == x.k) {
        reconnectionVertex.departure = scatter.pdf;
        reconnectionVertex.kept.direction = scatter.direction;
    } else {
        reconnectionVertex.kept.suffix *= scatter.weight;
    }
}

void noteLight(Vertex x, Segment to, Surface at)
{
    bool joins = reconnectionVertex.index == 0u && joinsLight(x.k + 1u, x.s, at.position, to.distance, to.arrival);
    float unit = to.hit.triangle == NO_HIT ? 1.0 : unitOfArea(at);
    lightVertex = NO_VERTEX;
    lightVertex.index = joins ? x.k + 1u : 0u;
    lightVertex.arrival = joins ? to.arrival * unit : 1.0;
    lightVertex.kept = Reconnection(to.hit.triangle, to.hit.barycentric, 0.0, to.scatter.direction, vec3(1.0));
}

// What is kept of a path that ends so. `last`: at x_r, so that what follows x_r is light; else `suffix` is what the scattering
// events after x_r and the end let through.
Reconnection suffixOf(Reconnection kept, bool last, vec3 suffix, Ending e)
{
    return last ? Reconnection(kept.triangle, kept.barycentric, e.lightPdf, e.direction, e.radiance)
                : Reconnection(kept.triangle, kept.barycentric, 0.0, kept.direction, suffix);
}

// Of f's measure over primary sample space, of a path that reconnects at x_r: p_(r-1) G, and p_r where scattering left x_r.
float densityOf(uint r, uint pathId, float arrival, float departure)
{
    return pathId == makePathId(r, BY_LIGHT) ? arrival : arrival * departure;
}

// The path just emitted as a sample; `density` turns its contribution in primary sample space into f(Y).
PathSample sampleOf(PathSeed seed, uint pathId, Ending e, out float density)
{
    density = 1.0;
    if (SHIFT_MAP == SHIFT_REPLAY) return PathSample(seed, pathId, 0u, NO_VERTEX.kept, 1.0);
    bool byLight = techniqueOf(pathId) == BY_LIGHT;
    ReconnectionVertex x = reconnectionVertex;
    if (x.index == 0u && !byLight) x = lightVertex;
    bool last = x.index == scatteringsOf(pathId); // what follows x_r is light
    density = densityOf(x.index, pathId, x.arrival, x.departure);
    return PathSample(seed, pathId, x.index, suffixOf(x.kept, last, x.kept.suffix * e.weighted, e), density);
}

#endif
