// What C++ and the kernels of the shift maps' test tell each other.
#ifndef TESTS_SHADERS_PATH_SHIFTS_H
#define TESTS_SHADERS_PATH_SHIFTS_H

#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST uint SHIFT_PATHS = 10u; // of a tree: ids 2 to 11, that is up to five scattering events

// How a path found its light.
SHARED_CONST uint DIRAC_SAMPLED = 0u;
SHARED_CONST uint LAMP_SAMPLED = 1u;
SHARED_CONST uint SKY_SAMPLED = 2u;
SHARED_CONST uint LAMP_MET = 3u;
SHARED_CONST uint SKY_MET = 4u;
SHARED_CONST uint ENDING_KINDS = 5u;

// A path tree to walk, in the domain of a pixel.
struct Tree {
    uint pixel;
    uint seedFrame;
    uint seedPixel;
    uint padding0;
    uvec4 replaced[2]; // xyz: instead of the first three random numbers of block w; 0: of none
};

// A path, as canonical.comp offers it to reservoirs.
struct OfferedPath {
    uint seedFrame;
    uint seedPixel;
    uint pathId; // 0: there is no such path
    uint reconnectionIndex;
    uint triangle;
    float density;
    vec2 barycentric;
    vec4 direction; // xyz; w: lightPdf
    vec4 suffix;    // xyz; w: ending
    vec4 f;         // xyz: in primary sample space
};

// Where a path scatters, and what its next direction is drawn from.
struct Scattering {
    vec4 position;  // xyz; w: 1 when the path was there
    vec4 tangent;   // xyz: of the frame in which directions are drawn; w: alphaG
    vec4 bitangent; // xyz; w: eta
    vec4 normal;    // xyz: n_s; w: 1 when transmission refracts
    vec4 wo;        // xyz: in that frame
    vec4 pick;      // xyz: probabilities of diffuse, specular reflection, transmission
};

struct ShiftedPath {
    vec4 f;            // xyz: f(T Y); w: outcome, SHIFT_*
    vec4 density;      // x: of f's measure over primary sample space, there
    Scattering before; // x_(r-1)
    Scattering at;     // x_r
    vec4 corners[3];   // xyz: of x_r's triangle
};

SHARED_END
#endif
