// Which pixels lend their reservoirs. Chosen by numbers and geometry, never by what the reservoirs hold: anything else
// would bias the result.
#ifndef SHADERS_RESTIR_NEIGHBORS_GLSL
#define SHADERS_RESTIR_NEIGHBORS_GLSL

const uint NEIGHBOR_ATTEMPTS = 4u;

// A pixel of the same run within frame.neighborRadius of `at` that sees a like surface; NO_NEIGHBOR when the attempts find none.
uint chooseNeighbor(uvec2 at, uint slot, Domain here)
{
    int runTop = int(at.y / frame.runHeight * frame.runHeight);
    for (uint attempt = 0u; attempt < NEIGHBOR_ATTEMPTS; ++attempt) {
        uvec4 random = decisionRandom(at.y * frame.width + at.x, STREAM_NEIGHBORS + slot * NEIGHBOR_ATTEMPTS + attempt);
        float radius = frame.neighborRadius * sqrt(unitFloat(random.x));
        float angle = 6.2831853 * unitFloat(random.y);
        ivec2 p = ivec2(at) + ivec2(round(radius * vec2(cos(angle), sin(angle))));
        bool inside = p.x >= 0 && p.y >= runTop && p.x < int(frame.width) && p.y < runTop + int(frame.runHeight);
        if (!inside || p == ivec2(at)) continue;
        uint pixel = uint(p.y) * frame.width + uint(p.x);
        if (alike(here, makeDomain(pixel, false))) return pixel;
    }
    return NO_NEIGHBOR;
}

#endif
