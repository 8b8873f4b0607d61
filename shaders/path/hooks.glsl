// All that a stage must define for what it includes of shaders/path, and what it is told.
//
// STAGE (STAGE_*)      of whoever shifts: under which number values that are not finite are counted
// DEFERS_SHADOW_RAYS   the stage defines emitUnlessBlocked itself
#ifndef SHADERS_PATH_HOOKS_GLSL
#define SHADERS_PATH_HOOKS_GLSL

#include "restir/path_id.glsl"
#include "restir/reservoir.glsl"
#include "scene/bsdf.glsl"
#include "scene/camera.glsl"

// x_k, about to scatter.
struct Vertex {
    uint k;
    Surface s;
    Bsdf bsdf;
    vec3 throughput; // of the scattering events before x_k, over their densities
};

// The last step of a path, from x_k to light.
struct Ending {
    vec3 direction; // unit
    vec3 radiance;  // from there; for Dirac lights over the density
    vec3 weighted;  // by what the throughput is multiplied
    float lightPdf; // of next-event estimation, solid angle at x_k; 0 where it cannot find this light; -1: a Dirac light
};

struct ShadowRay {
    Ray ray;
    uint alphaSeed;
};

// Of walk.glsl. Whoever includes shift.glsl or candidates.glsl has these from there.
bool visit(Vertex x);                     // x_k was reached; false: go no further
bool wants(uint pathId);                  // is this path, by next-event estimation, of interest?
bool goesOn(uint k);                      // is any path of interest that scatters at x_k or beyond?
void emit(uint pathId, vec3 f, Ending e); // a path that carries light. f is its MIS-weighted contribution over its density:
                                          // the integrand in primary sample space
void emitUnlessBlocked(uint pathId, vec3 f, Ending e, ShadowRay shadow); // now, or after the walk

// Of candidates.glsl. A path that carries light: f in primary sample space; f times `density` is f(Y), in the measure that
// shifts preserve.
void offer(PathSample y, vec3 f, float density);
bool seeks(uint pathId);      // is this path, by next-event estimation, wanted?
bool seeksBeyond(uint k);     // is any that scatters at x_k or beyond?

#endif
