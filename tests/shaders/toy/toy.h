// A world whose integrals are known in closed form, in place of scenes: what C++ and GLSL share of it.
//
// A path of the toy is a number x in [0, 1) and one of two ids, TOY_FIRST_PATH and the next. Its contribution in a
// domain is
//     h(x) = albedo * cell[id][floor(4 x)] * (1 + 2 x),  0 where |x - occluder| < OCCLUDER_SIZE.
// Domain differs from domain in all of these, in particular in what each channel sees at all. Candidates draw x with
// density p(x) = 1 + slope (2 x - 1) by inversion of a uniform number.
//
// Replay keeps the uniform number. Reconnection keeps x where both domains allow that, |T'| = p'(x) / p(x) in primary
// sample space; like the product, the toy takes f in the measure of x instead. Hybrid replays what cannot be kept.
#ifndef TESTS_SHADERS_TOY_TOY_H
#define TESTS_SHADERS_TOY_TOY_H

#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST uint TOY_GROUP = 8u; // runs; they are independent of other groups', not of each other
SHARED_CONST uint TOY_PATHS = 2u;
SHARED_CONST uint TOY_FIRST_PATH = 3u; // its id: of another length than the second one
SHARED_CONST uint TOY_CELLS = 4u;      // of a path id
SHARED_CONST float TOY_OCCLUDER_SIZE = 0.08f;

struct ToyDomain {
    vec4 albedo;        // rgb
    float slope;        // in (-1, 1)
    float occluder;     // in [0, 1]
    float phase;        // x can be kept where fract(4 x + phase) >= 1/4
    float likeness;     // domains are alike when these differ by less than 0.3
    uint seen;          // 0: there is nothing to integrate
    uint previousPixel; // of the same run; 0xffffffff: none
    uint padding0;
    uint padding1;
};

SHARED_END
#endif
