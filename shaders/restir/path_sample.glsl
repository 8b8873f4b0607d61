// A sample: one path of a path tree, by the numbers that drew it. Opaque to resampling, which only moves it about.
#ifndef SHADERS_RESTIR_PATH_SAMPLE_GLSL
#define SHADERS_RESTIR_PATH_SAMPLE_GLSL

#include "lib/random.glsl"

// From vertex x_r on a reconnected path is kept as it is: what shifts need to know of that part.
struct Reconnection {
    uint triangle;    // of x_r; NO_HIT: x_r is the environment in `direction`
    vec2 barycentric; // of x_r
    float lightPdf;   // of the path's light by the other technique, solid angle at x_r; 0: no weight depends on x_(r-1)
    vec3 direction;   // x_r -> x_(r+1), unit
    vec3 suffix;      // radiance that arrives at x_r from there, over the densities that drew it
};

struct PathSample {
    PathSeed seed;
    uint pathId;            // which path of the tree: path/path_id.glsl
    uint reconnectionIndex; // r of the reconnection vertex x_r; 0: the whole path is replayed
    Reconnection reconnection; // when reconnectionIndex > 0
};

#endif
