// In place of path/domain.glsl: the toy's domains.
#ifndef TESTS_SHADERS_TOY_DOMAIN_GLSL
#define TESTS_SHADERS_TOY_DOMAIN_GLSL

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

void enterWorld(bool previous) {}
Domain carriedOn(Domain before) { return before; }

bool reproject(Domain here, uint pixel, out uint previousPixel)
{
    previousPixel = pixel;
    if (SAME_VIEW) return true;
    previousPixel = pixel / runPixels() * runPixels() + here.toy.previousPixel;
    return here.toy.previousPixel != NO_NEIGHBOR;
}

#endif
